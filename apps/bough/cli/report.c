// bough report: one page of a results folder.
#include "apps/bough/results/report.h"

#include "apps/bough/cli/verb.h"

bough_status bough_verb_report(bough_arena *arena, const bough_options *options) {
    (void)arena;
    bough_status status = bough_report_write(options->n_operand, options->operands);
    if (bough_is_ok(&status)) printf("report: %s/report.html\n", options->operand);
    return status;
}
