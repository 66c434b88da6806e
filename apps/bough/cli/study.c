// bough study: many runs of one scene, compared.
#include "apps/bough/cases/study_perform.h"

#include "apps/bough/cli/open.h"
#include "apps/bough/cli/stop.h"
#include "apps/bough/cli/verb.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/results/lock.h"

bough_status bough_verb_study(bough_arena *arena, const bough_options *options) {
    bough_errors errors = {.arena = arena};
    bough_study *study;
    bough_status status = bough_study_read(arena, options->operand, options->threads, &errors, &study);
    if (errors.n > 0 && status.code == BOUGH_INVALID) {
        bough_errors_print(&errors, stderr);
        status.message[0] = '\0';
    }
    if (!bough_is_ok(&status)) return status;
    bough_study_options how = {.folder = bough_out_folder(arena, options),
                               .part = options->part,
                               .parts = options->parts,
                               .only = options->only,
                               .quiet = options->quiet,
                               .stop = bough_stop_requested,
                               .stream = stdout};
    if (!(options->parts > 0) && !study->load_set) { // parts and load sets share a folder
        status = bough_folder_make(how.folder);
        if (bough_is_ok(&status)) status = bough_lock_folder(arena, how.folder);
        if (!bough_is_ok(&status)) return status;
        bough_folder_clean(how.folder);
    }
    bough_stop_listen();
    status = bough_study_perform(arena, study, &how);
    if (bough_is_ok(&status)) printf("out: %s\n", how.folder);
    return status;
}
