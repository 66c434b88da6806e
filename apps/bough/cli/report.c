// bough report: one page of a results folder.
#include "apps/bough/results/report.h"

#include "apps/bough/cli/command.h"

typedef struct report_options {
    bough_options common;
    struct moment {
        bool given;  // false: the last frame
        double time; // [s]
    } at;
} report_options;

static bough_status read_time(const bough_option *row, const char *text, void *field) {
    struct moment *at = field;
    at->given = true;
    return bough_option_quantity(row, text, &at->time);
}

static const bough_option rows[] = {
    {"at", "TIME", "of the stored frame that shape.svg shows; default the last", read_time,
     .offset = offsetof(report_options, at), .dimension = BOUGH_TIME},
    {0},
};

static bough_status report(bough_arena *arena, const void *given) {
    const report_options *own = given;
    const bough_options *options = &own->common;
    bough_status status = bough_report_write(arena, options->n_operand, options->operands);
    bool drawn = false;
    if (bough_is_ok(&status)) {
        printf("report: %s/report.html\n", options->operand);
        status = bough_report_shape(arena, options->operand, own->at.given ? own->at.time : HUGE_VAL, &drawn);
    }
    if (drawn) printf("picture: %s/shape.svg\n", options->operand);
    return status;
}

const bough_command bough_command_report = {
    .name = "report",
    .summary = "makes one page of the results of a run or a study, or of several runs side by side: "
               "DIR/report.html; of stored frames also a picture, DIR/shape.svg",
    .operands = "DIR",
    .repeats = true,
    .option = rows,
    .size = sizeof(report_options),
    .run = report,
};
