// bough report: one page of a results folder.
#include "apps/bough/results/report.h"

#include "apps/bough/cli/command.h"

static const bough_option rows[] = {{0}};

static bough_status report(bough_arena *arena, const void *given) {
    (void)arena;
    const bough_options *options = given;
    bough_status status = bough_report_write(options->n_operand, options->operands);
    if (bough_is_ok(&status)) printf("report: %s/report.html\n", options->operand);
    return status;
}

const bough_command bough_command_report = {
    .name = "report",
    .summary = "makes one page of the results of a run or a study, or of several runs side by side: "
               "DIR/report.html",
    .operand = BOUGH_OPERAND_SOME,
    .operand_name = "DIR",
    .option = rows,
    .size = sizeof(bough_options),
    .run = report,
};
