// What is said about the error of a run.
#include "apps/bough/cli/run.h"
#include "apps/bough/model/error_shares.h"
#include "apps/bough/results/summary.h"

#include <math.h>

enum { WORST = 3 };

static double bound_of(const bough_run *run) { return run->simulation->scene->simulation.error_bound; }

// A force or moment with an error above the bound, or "".
static void warn_of_force(const bough_run *run, char text[BOUGH_ERROR_WARNING]) {
    const bough_companion *c = run->companion;
    bough_error_verdict v = bough_error_verdict_of(c, false, c->error);
    text[0] = '\0';
    if (v.channel < 0 || !(bound_of(run) > 0) || v.relative <= bound_of(run)) return;
    const bough_channel *channel = &c->channels->channel[v.channel];
    snprintf(text, BOUGH_ERROR_WARNING, "%s errs by %.2g %s, %.2g of its range", channel->name,
             c->error[v.channel], channel->unit, v.relative);
}

// -- summary.json ---------------------------------------------------------------------------------

static void write_worst(bough_summary *s, const bough_run *run, bool motion) {
    const bough_companion *c = run->companion;
    bough_error_verdict v = bough_error_verdict_of(c, motion, c->error);
    bool known = v.channel >= 0;
    bough_summary_text(s, "channel", known ? c->channels->channel[v.channel].name : NULL);
    bough_summary_number(s, "relative", known ? v.relative : (double)NAN);
    bough_summary_number(s, "from", known && v.time >= 0 ? v.time : (double)NAN);
}

static void write_verdict(bough_summary *s, const bough_job *job) {
    const bough_companion *c = job->run.companion;
    char force[BOUGH_ERROR_WARNING];
    bough_summary_object(s, "error");
    bough_summary_text(s, "source", c->compared > 0 ? "companion" : "not estimated");
    bough_summary_text(s, "not_estimated", c->reason[0] ? c->reason : NULL);
    bough_summary_number(s, "not_estimated_from", c->reason[0] ? c->from : (double)NAN);
    bough_summary_number(s, "bound", bound_of(&job->run));
    write_worst(s, &job->run, true);
    bough_summary_text(s, "warning", job->warning[0] ? job->warning : NULL);
    warn_of_force(&job->run, force);
    bough_summary_object(s, "force");
    write_worst(s, &job->run, false);
    bough_summary_text(s, "warning", force[0] ? force : NULL);
    bough_summary_end(s);
    bough_summary_end(s);
}

// A number for each channel, in its unit.
static void write_channels(bough_summary *s, const bough_run *run, const char *key, const double *error) {
    bough_summary_object(s, key);
    for (int i = 0; i < run->channels.count; i++) {
        double known = bough_companion_knows(run->companion, i) ? error[i] : (double)NAN;
        bough_summary_number(s, run->channels.channel[i].name, known);
    }
    bough_summary_end(s);
}

static void write_shares(bough_summary *s, const bough_job *job) {
    if (!job->shares.found) return;
    bough_summary_object(s, "error_shares");
    bough_summary_number(s, "cpu_s", job->shares.cpu_s);
    for (int k = 0; k < BOUGH_SHARES; k++) {
        const bough_error_share *share = &job->shares.share[k];
        const char *name = bough_error_share_name((bough_error_share_kind)k);
        if (share->unknown[0]) {
            bough_summary_object(s, name);
            bough_summary_text(s, "not_estimated", share->unknown);
            bough_summary_end(s);
        } else {
            write_channels(s, &job->run, name, share->largest);
        }
    }
    bough_summary_end(s);
}

void bough_run_write_error(bough_summary *s, const bough_job *job) {
    write_verdict(s, job);
    write_channels(s, &job->run, "error_estimate", job->run.companion->error);
    write_shares(s, job);
}

// -- closing lines --------------------------------------------------------------------------------

static void tell_shares(const bough_job *job, int channel, FILE *stream) {
    for (int k = 0; k < BOUGH_SHARES && job->shares.found; k++) {
        const bough_error_share *share = &job->shares.share[k];
        if (share->unknown[0]) continue;
        fprintf(stream, "; %s %.2g", bough_error_share_name((bough_error_share_kind)k),
                share->largest[channel]);
    }
}

void bough_run_tell_error(const bough_job *job, FILE *stream) {
    const bough_companion *c = job->run.companion;
    char warning[BOUGH_ERROR_WARNING];
    int worst[WORST], n = bough_error_worst(c, WORST, worst);
    if (c->compared == 0) {
        fprintf(stream, "error: not estimated: %s\n",
                c->reason[0] ? c->reason : "the run has not reached the companion's first step");
    } else if (n == 0) {
        fprintf(stream, "error: none: nothing moves\n");
    }
    for (int k = 0; k < n; k++) {
        const bough_channel *channel = &c->channels->channel[worst[k]];
        fprintf(stream, "error: %s %.2g %s, %.2g of its range", channel->name, c->error[worst[k]],
                channel->unit, bough_error_relative(c, worst[k], c->error[worst[k]]));
        tell_shares(job, worst[k], stream);
        fputc('\n', stream);
    }
    warn_of_force(&job->run, warning);
    if (job->warning[0]) fprintf(stream, "warning: %s\n", job->warning);
    if (warning[0]) fprintf(stream, "warning: %s\n", warning);
}
