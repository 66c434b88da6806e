// Little-endian numbers, whatever the processor.
#pragma once

#include <stdint.h>
#include <stdio.h>
#include <string.h>

// The n ≤ 8 bytes from b on as an unsigned number.
static inline uint64_t bough_bytes(const unsigned char *b, int n) {
    uint64_t bits = 0;
    for (int i = 0; i < n; i++) bits |= (uint64_t)b[i] << 8 * i;
    return bits;
}

// Two or four bytes as a signed number.
static inline int16_t bough_bytes_int16(const unsigned char *b) { return (int16_t)bough_bytes(b, 2); }

static inline int32_t bough_bytes_int32(const unsigned char *b) { return (int32_t)bough_bytes(b, 4); }

// Four bytes as a number of single precision.
static inline double bough_bytes_float(const unsigned char *b) {
    uint32_t bits = (uint32_t)bough_bytes(b, 4);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

// Writes the lowest n bytes of a number.
static inline void bough_put_bytes(FILE *file, uint64_t bits, int n) {
    for (int i = 0; i < n; i++) fputc((int)(bits >> 8 * i & 0xff), file);
}

static inline void bough_put_float(FILE *file, float x) {
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    bough_put_bytes(file, bits, 4);
}

static inline void bough_put_double(FILE *file, double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bough_put_bytes(file, bits, 8);
}
