#include "apps/bough/import/wind_given.h"

#include "aero/wind/wind_hub.h"
#include "apps/bough/import/wind_convert.h"

bough_wind_form bough_wind_form_of(const char *path) {
    unsigned char b[2] = {0};
    FILE *file = fopen(path, "rb");
    if (!file) return BOUGH_WIND_UNIFORM_FILE; // whose reader says why
    size_t n = fread(b, 1, 2, file);
    fclose(file);
    int first = b[0] | b[1] << 8;
    if (n == 2 && (first == 7 || first == 8)) return BOUGH_WIND_TURBSIM;
    return n == 2 && first >= 0xFF00 ? BOUGH_WIND_BLADED : BOUGH_WIND_UNIFORM_FILE;
}

void bough_wind_made(bough_draft *d, const bough_wind_box *box, const char *path) {
    d->box = box;
    fputs("  wind: {kind: bts, file: " BOUGH_IMPORT_BOX, d->file[BOUGH_IMPORT_SCENE]);
    bough_draft_note(d, BOUGH_TAKEN, "wind of %s, as " BOUGH_IMPORT_BOX, path);
}

static void put(bough_draft *d, bough_wind_form form, const char *path, double height, double diameter) {
    FILE *file = d->file[BOUGH_IMPORT_SCENE];
    bool box = form == BOUGH_WIND_TURBSIM;
    fprintf(file, "  wind: {kind: %s, file: ", box ? "bts" : "wnd");
    bough_import_path(file, path);
    if (!box) {
        fprintf(file, ", reference_height: %.10g m, reference_length: %.10g m", height, diameter);
    }
    bough_draft_note(d, BOUGH_TAKEN, "wind of %s, by its path", path);
}

bough_status bough_wind_given(bough_draft *d, bough_wind_form form, const char *path, double height,
                              double diameter) {
    bough_wind_box *box = bough_arena_take(d->arena, sizeof *box);
    bough_wind_hub hub;
    bough_status status = bough_ok();
    switch (form) {
    case BOUGH_WIND_UNIFORM_FILE: status = bough_wind_hub_read(d->arena, path, &hub); break;
    case BOUGH_WIND_TURBSIM: status = bough_wind_box_read(d->arena, path, box); break;
    case BOUGH_WIND_BLADED: status = bough_wind_bladed_read(d->arena, path, box); break;
    }
    if (!bough_is_ok(&status)) return status;
    if (form == BOUGH_WIND_BLADED)
        bough_wind_made(d, box, path);
    else
        put(d, form, path, height, diameter);
    return status;
}
