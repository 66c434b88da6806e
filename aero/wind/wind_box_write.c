// A box as a TurbSim full-field file: see wind_box.h for the layout.
#include "aero/wind/wind_box.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PIECE = 4096, TEXT = 100 };

static void put16(FILE *f, int value) {
    unsigned u = (unsigned)value;
    putc((int)(u & 0xFF), f);
    putc((int)(u >> 8 & 0xFF), f);
}

static void put32(FILE *f, int32_t value) {
    uint32_t u = (uint32_t)value;
    put16(f, (int)(u & 0xFFFF));
    put16(f, (int)(u >> 16));
}

static void put_float(FILE *f, double value) {
    float x = (float)value;
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    put32(f, bits);
}

static void put_head(FILE *f, const bough_wind_box *box, const char *text) {
    const double measures[] = {box->dz, box->dy, box->dt, box->mean, box->hub, box->bottom};
    int length = (int)strnlen(text, TEXT);
    put16(f, box->periodic ? 8 : 7);
    put32(f, box->n_z);
    put32(f, box->n_y);
    put32(f, box->n_tower);
    put32(f, box->n_time);
    for (int i = 0; i < 6; i++) put_float(f, measures[i]);
    for (int c = 0; c < 3; c++) {
        put_float(f, 1 / box->scale[c]);
        put_float(f, box->offset[c]);
    }
    put32(f, length);
    fwrite(text, 1, (size_t)length, f);
}

bool bough_wind_box_write(const bough_wind_box *box, const char *text, FILE *f) {
    int64_t points = (int64_t)box->n_z * box->n_y + box->n_tower;
    put_head(f, box, text);
    for (int64_t k = 0; k < 3 * points * box->n_time; k++) put16(f, box->value[k]);
    return !ferror(f);
}
