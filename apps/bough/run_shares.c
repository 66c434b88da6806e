// What is said about the shares of mesh and air in a run's error.
#include "apps/bough/run.h"
#include "apps/output/summary.h"

static void warn(const bough_job *job, int kind, char warning[BOUGH_ERROR_WARNING]) {
    bough_error_share_warn(&job->shares, (bough_error_share_kind)kind, &job->run.probe,
                           job->run.simulation->scene->simulation.error_bound, warning);
}

void bough_run_write_shares(bough_summary *s, const bough_job *job) {
    for (int kind = 0; kind < BOUGH_SHARES; kind++) {
        const bough_error_share *share = &job->shares.share[kind];
        bool mesh = kind == BOUGH_SHARE_MESH, known = share->unknown[0] == '\0';
        char warning[BOUGH_ERROR_WARNING];
        bough_summary_object(s, mesh ? "mesh_error_estimate" : "air_error_estimate");
        bough_summary_text(s, "not_estimated", known ? NULL : share->unknown);
        warn(job, kind, warning);
        bough_summary_text(s, "warning", warning[0] ? warning : NULL);
        if (known) bough_summary_number(s, "cpu_s", share->cpu_s);
        for (int i = 0; known && i < job->shares.n_channel; i++) {
            bough_summary_object(s, job->run.channels.channel[i].name);
            bough_summary_text(s, "unit", job->run.channels.channel[i].unit);
            bough_summary_number(s, "largest", share->largest[i]);
            bough_summary_number(s, "relative",
                                 bough_error_probe_relative(&job->run.probe, i, share->largest[i]));
            bough_summary_end(s);
        }
        bough_summary_end(s);
    }
}

void bough_run_tell_channel_shares(const bough_job *job, int channel, FILE *stream) {
    const bough_channel *c = &job->run.channels.channel[channel];
    for (int kind = 0; kind < BOUGH_SHARES && channel < job->shares.n_channel; kind++) {
        const bough_error_share *share = &job->shares.share[kind];
        if (share->unknown[0]) continue;
        fprintf(stream, "%s_%s_error: %.2g %s\n", c->name,
                bough_error_share_name((bough_error_share_kind)kind), share->largest[channel], c->unit);
    }
}

// Whether the scene has what the share is of.
static bool has_part(const bough_scene *scene, int kind) {
    if (kind == BOUGH_SHARE_AIR) return scene->aero.node != NULL;
    for (int i = 0; i < scene->n_body; i++) {
        if (scene->body[i].rod.node && scene->body[i].fidelity != BOUGH_SCENE_RIGID) return true;
    }
    return false;
}

void bough_run_tell_shares(const bough_job *job, FILE *stream) {
    for (int kind = 0; kind < BOUGH_SHARES; kind++) {
        const bough_error_share *share = &job->shares.share[kind];
        const char *name = bough_error_share_name((bough_error_share_kind)kind);
        char warning[BOUGH_ERROR_WARNING];
        if (!has_part(job->run.simulation->scene, kind)) continue;
        if (share->unknown[0]) fprintf(stream, "%s error: not estimated: %s\n", name, share->unknown);
        warn(job, kind, warning);
        if (warning[0]) fprintf(stream, "warning: %s\n", warning);
    }
}
