// What a DBC leaves to be written by hand of the supplies' identifiers.
static inline bool is_controller(uint8_t address) {
    return address >= 0xF0 && address <= 0xF8;
}

// Returns the identifier that the DBC knows, or 0.
static inline uint32_t known(uint32_t id) {
    return id >> 30 == 2 && is_controller(id & 0xFF) ? (id & 0x3F0000) | 0x150000F0 : 0;
}

// Returns the address of the supply.
static inline uint8_t address(uint32_t id) {
    return id >> 8 & 0xFF;
}
