//! The rules on what is written, and some rules on what is meant that are tested here already.

use crate::report::rule::{Rule, rules};

rules! {
    MISPLACED_KEY "misplaced_key" Resolve ERROR;
    VERSION "version" Resolve ERROR;
    IDENTIFIER_NAME "identifier_name" Resolve ERROR;
    NAME "name" Resolve ERROR;
    NUMBER "number" Resolve ERROR;
    RANGE "range" Resolve ERROR;
    UNIT "unit" Resolve EITHER;
    PLACE "place" Resolve ERROR;
    IDENTIFIER_LAYOUT "identifier_layout" Resolve ERROR;
    TYPE "type" Resolve ERROR;
    FORMAT "format" Resolve ERROR;
    UNUSED_TYPE "unused_type" Resolve WARNING;
    NAMED_VALUE "named_value" Resolve ERROR;
    VALUE_WIDTH "value_width" Resolve ERROR;
    STATUS_BIT "status_bit" Resolve ERROR;
    ARRAY "array" Resolve ERROR;
    PARTS "parts" Resolve ERROR;
    TRANSPORT "transport" Check ERROR;
    VALUE "value" Resolve ERROR;
    ADDRESSING "addressing" Resolve EITHER;
    ACCESS "access" Resolve ERROR;
    MATCH "match" Resolve ERROR;
    MODEL_RANGE "model_range" Check EITHER;
    SET "set" Check ERROR;
    QUANTITY_PATH "quantity_path" Check ERROR;
    PRODUCT_LIMIT "product_limit" Check EITHER;
    EXAMPLE "example" Check ERROR;
}

/// All rules of the stage, in order.
pub static RULES: &[&Rule] = &[
    &MISPLACED_KEY,
    &VERSION,
    &IDENTIFIER_NAME,
    &NAME,
    &NUMBER,
    &RANGE,
    &UNIT,
    &PLACE,
    &IDENTIFIER_LAYOUT,
    &TYPE,
    &FORMAT,
    &UNUSED_TYPE,
    &NAMED_VALUE,
    &VALUE_WIDTH,
    &STATUS_BIT,
    &ARRAY,
    &PARTS,
    &VALUE,
    &ADDRESSING,
    &ACCESS,
    &MATCH,
];
