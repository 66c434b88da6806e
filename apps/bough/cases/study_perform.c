#include "apps/bough/cases/study_perform.h"

#include "apps/bough/cases/load_set_perform.h"
#include "apps/bough/cases/study_plot.h"
#include "apps/bough/cases/study_stability.h"
#include "apps/bough/cases/study_timing.h"

static bough_status work_precision(bough_arena *arena, const bough_study *study,
                                   const bough_study_options *options) {
    bough_study_results results;
    bough_status status = bough_study_cells(arena, study, options, &results);
    if (bough_is_ok(&status)) status = bough_study_write_tables(&results, options->folder);
    if (bough_is_ok(&status)) status = bough_study_plot(&results, options->folder);
    if (bough_is_ok(&status)) bough_study_print(&results, options->stream);
    return status;
}

typedef bough_status perform_function(bough_arena *arena, const bough_study *study,
                                      const bough_study_options *options);

static perform_function *const kinds[] = {[BOUGH_STUDY_WORK_PRECISION] = work_precision,
                                          [BOUGH_STUDY_SWEEP] = bough_load_set_perform,
                                          [BOUGH_STUDY_LOAD_SET] = bough_load_set_perform,
                                          [BOUGH_STUDY_TIMING] = bough_timing_perform,
                                          [BOUGH_STUDY_STABILITY] = bough_stability_perform};

bough_status bough_study_perform(bough_arena *arena, const bough_study *study,
                                 const bough_study_options *options) {
    if (options->parts > 0 && !study->is.parallel) {
        return bough_fail(BOUGH_INVALID, "only studies of kind stability, sweep and load-set run in parts");
    }
    if (options->only && !study->is.weighted) {
        return bough_fail(BOUGH_INVALID, "only a load set has load cases to choose by --case");
    }
    return kinds[study->kind](arena, study, options);
}
