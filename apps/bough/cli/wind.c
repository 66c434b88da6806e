// bough wind: the turbulence of a scene as a TurbSim full-field file, for other programs.
#include "apps/bough/cli/command.h"
#include "apps/bough/model/aero_link.h"
#include "apps/bough/results/folder.h"

static void put_box(const void *self, FILE *file) {
    const bough_simulation *s = self;
    const bough_wind_box *box = bough_rotor_wind(bough_aero_link_rotor(s->aero))->box;
    bough_wind_box_write(box, s->scene->title ? s->scene->title : s->scene->file, file);
}

static const bough_option rows[] = {BOUGH_OPTION_SET, BOUGH_OPTION_OUT, {0}};

static bough_status wind(bough_arena *arena, const void *options) {
    bough_simulation *s;
    BOUGH_TRY(bough_open(arena, options, &s));
    const bough_wind *field = s->aero ? bough_rotor_wind(bough_aero_link_rotor(s->aero)) : NULL;
    if (!field || !field->box) {
        return bough_fail(BOUGH_INVALID,
                          "%.150s has no turbulent wind: aero.wind of 'kind: iec' with 'condition: "
                          "ntm', etm or ewm makes it",
                          s->scene->file);
    }
    const char *folder = bough_out_folder(arena, options);
    const bough_wind_box *box = field->box;
    printf("points: %d x %d, %.6g m apart, lowest at %.6g m\n", box->n_z, box->n_y, box->dz, box->bottom);
    printf("times: %d, every %.6g s, period %.6g s\n", box->n_time, box->dt, box->duration);
    printf("mean_speed: %.6g m/s at %.6g m\n", box->mean, box->hub);
    BOUGH_TRY(bough_folder_write(folder, "wind.bts", put_box, s));
    printf("wind: %s/wind.bts\n", folder);
    return bough_ok();
}

const bough_command bough_command_wind = {
    .name = "wind",
    .summary = "writes the turbulence of a scene for other programs: wind.bts",
    .operands = "SCENE",
    .option = rows,
    .size = sizeof(bough_options),
    .run = wind,
};
