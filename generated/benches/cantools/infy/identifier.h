// What a DBC leaves to be written by hand of INFY's identifiers.
static inline bool is_controller(uint8_t address) {
    return address >= 0xF0 && address <= 0xF8;
}

// Returns the identifier that the DBC knows, or 0.
static inline uint32_t known(uint32_t id) {
    bool is_reply = is_controller(id >> 8 & 0xFF);
    if (id >> 30 != 2 || is_controller(id & 0xFF) == is_reply) return 0;
    return (id & 0x3F0000) | (is_reply ? 0x280F000 : 0x28000F0);
}

// Returns the address of the sender.
static inline uint8_t address(uint32_t id) {
    return id;
}
