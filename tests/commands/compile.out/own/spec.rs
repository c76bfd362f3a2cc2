canspec: 1
protocol: spec
title: A heater
document: {title: Heater manual, version: "1"}
length: 2
identifier:
  direction: {bits: 10}
  command:   {bits: 9..4}
  node:      {bits: 3..0}
types:
  heater: {range: 1..9, section: "1"}
addressing:
  single:
    request: {direction: 0, node: heater}
    one:     {direction: 1, node: heater}
access:
  read: {request: {}, reply: {}, in: [reply], answers: {single: one}, section: "2"}
messages:
  temperature:
    section: "2"
    match: {command: 1}
    access: [read]
    fields:
      inside: {bytes: 0..1, scale: 1/10, unit: °C}
    examples:
      - {request: 011#0000}
      - {reply: 411#00C8, means: {inside: 20 °C}}
