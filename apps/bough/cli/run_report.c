// The report of a run: summary.json and the closing lines.
#include "apps/bough/cli/run.h"
#include "apps/bough/model/error_verdict.h"
#include "apps/bough/model/validity.h"
#include "apps/bough/results/summary.h"
#include "core/base/level.h"

#include <sys/resource.h>

enum { WORST = 3 };

static double bound_of(const bough_run *run) { return run->simulation->scene->simulation.error_bound; }

// A warning about a force or moment with an error above the bound, or "".
static void warn_of_force(const bough_run *run, char text[BOUGH_ERROR_WARNING]) {
    const bough_companion *c = run->companion;
    bough_error_verdict v = bough_error_verdict_of(c, false, c->error);
    text[0] = '\0';
    if (v.channel < 0 || !(bound_of(run) > 0) || v.relative <= bound_of(run)) return;
    char error[BOUGH_ERROR_SIZE];
    bough_error_size(c, v.channel, error);
    snprintf(text, BOUGH_ERROR_WARNING, "%s errs by %s%s", c->channels->channel[v.channel].name, error,
             run->simulation->scene->simulation.error_shares
                 ? ""
                 : "; simulation.error_shares: true finds the cause");
}

// A warning about macro steps that ended before they had converged, or "".
static void warn_of_steps(const bough_run *run, char text[BOUGH_ERROR_WARNING]) {
    const bough_master *m = run->simulation->master;
    long unfinished = bough_scheme_reported(m->coupling).unfinished;
    text[0] = '\0';
    if (unfinished == 0) return;
    snprintf(text, BOUGH_ERROR_WARNING,
             "%ld of %ld macro steps ended before they had converged; the stated error includes the effect",
             unfinished, m->steps);
}

// -- memory ---------------------------------------------------------------------------------------

// getrusage alone is wrong: on Linux exec keeps its value, which may be that of a large program that started
// this one.
static long long peak_memory(void) {
    long long kilobytes = 0;
    char line[128];
    FILE *file = fopen("/proc/self/status", "r");
    while (file && kilobytes == 0 && fgets(line, sizeof line, file)) {
        if (sscanf(line, "VmHWM: %lld kB", &kilobytes) != 1) kilobytes = 0;
    }
    if (file) fclose(file);
    struct rusage usage;
    if (kilobytes == 0 && getrusage(RUSAGE_SELF, &usage) == 0) kilobytes = usage.ru_maxrss;
    return 1024 * kilobytes;
}

// -- figures --------------------------------------------------------------------------------------

static const char *outcome_name(const bough_run *run) {
    if (bough_is_ok(&run->outcome)) return "complete";
    return run->outcome.code == BOUGH_INTERRUPTED ? "interrupted" : "failed";
}

static double real_time_factor(const bough_run *run) { return run->simulation->master->time / run->wall_s; }

// -- summary.json ---------------------------------------------------------------------------------

static void write_worst(bough_summary *s, const bough_run *run, bool motion) {
    const bough_companion *c = run->companion;
    bough_error_verdict v = bough_error_verdict_of(c, motion, c->error);
    bool known = v.channel >= 0;
    bough_summary_text(s, "channel", known ? c->channels->channel[v.channel].name : NULL);
    bough_summary_number(s, "relative", known ? v.relative : (double)NAN);
    bough_summary_number(s, "from", known && v.time >= 0 ? v.time : (double)NAN);
}

static void write_verdict(bough_summary *s, const bough_run_command *command) {
    const bough_companion *c = command->run.companion;
    char force[BOUGH_ERROR_WARNING];
    bough_summary_object(s, "error");
    bough_summary_text(s, "source", c->compared > 0 ? "companion" : "not estimated");
    bough_summary_text(s, "not_estimated", c->reason[0] ? c->reason : NULL);
    bough_summary_number(s, "not_estimated_from", c->reason[0] ? c->from : (double)NAN);
    bough_summary_number(s, "bound", bound_of(&command->run));
    write_worst(s, &command->run, true);
    bough_summary_text(s, "warning", command->warning[0] ? command->warning : NULL);
    warn_of_force(&command->run, force);
    bough_summary_object(s, "force");
    write_worst(s, &command->run, false);
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

static void write_shares(bough_summary *s, const bough_run_command *command) {
    if (!command->shares.found) return;
    bough_summary_object(s, "error_shares");
    bough_summary_number(s, "cpu_s", command->shares.cpu_s);
    for (int k = 0; k < BOUGH_SHARES; k++) {
        const bough_error_share *share = &command->shares.share[k];
        const char *name = bough_error_share_name((bough_error_share_kind)k);
        if (share->unknown[0]) {
            bough_summary_object(s, name);
            bough_summary_text(s, "not_estimated", share->unknown);
            bough_summary_end(s);
        } else {
            write_channels(s, &command->run, name, share->largest);
        }
    }
    bough_summary_end(s);
}

static void write_input(bough_summary *s, const bough_run_command *command) {
    const bough_scene *scene = command->run.simulation->scene;
    bough_summary_text(s, "bough_version", BOUGH_VERSION);
    bough_summary_text(s, "scene", scene->file);
    bough_summary_text(s, "title", scene->title);
    bough_summary_array(s, "set");
    for (int i = 0; i < command->options->common.set.n; i++) {
        bough_summary_text(s, NULL, command->options->common.set.text[i]);
    }
    bough_summary_end(s);
    bough_summary_text(s, "status", outcome_name(&command->run));
    const char *verdict = command->run.simulation->master->verdict;
    bough_summary_text(s, "verdict", verdict[0] ? verdict : NULL);
    const bough_status *end = bough_is_ok(&command->run.outcome) ? &command->verdict : &command->run.outcome;
    bough_summary_text(s, "diagnosis", bough_is_ok(end) ? NULL : end->message);
}

// Body and time are those of the first passing of a limit; otherwise they are null.
static void write_warning(bough_summary *s, const char *limit, const char *body, double time,
                          const char *text) {
    if (!text[0]) return;
    bough_summary_object(s, NULL);
    bough_summary_text(s, "limit", limit);
    bough_summary_text(s, "body", body);
    bough_summary_number(s, "time", time);
    bough_summary_text(s, "text", text);
    bough_summary_end(s);
}

// All that the run warns of: the error, a coupling that grows, steps that did not converge, limits of the
// models.
static void write_warnings(bough_summary *s, const bough_run_command *command) {
    const bough_simulation *simulation = command->run.simulation;
    char text[BOUGH_ERROR_WARNING];
    bough_summary_array(s, "warnings");
    write_warning(s, "error", NULL, (double)NAN, command->warning);
    warn_of_force(&command->run, text);
    write_warning(s, "error", NULL, (double)NAN, text);
    write_warning(s, "coupling", NULL, (double)NAN, simulation->master->verdict);
    warn_of_steps(&command->run, text);
    write_warning(s, "unfinished_steps", NULL, (double)NAN, text);
    for (int k = 0; k < BOUGH_LIMITS; k++) {
        const bough_passing *p = &simulation->validity->limit[k];
        if (!p->passed) continue;
        bough_validity_describe(simulation, k, text, sizeof text);
        write_warning(s, bough_limit_name(k), simulation->scene->body[p->body].name, p->time, text);
    }
    bough_summary_end(s);
}

// Order and theta are null if the scheme has none; sweeps are 0 if it does not repeat macro steps.
static void write_method(bough_summary *s, const bough_run *run) {
    const bough_master *m = run->simulation->master;
    const bough_scene_simulation *sim = &run->simulation->scene->simulation;
    const bough_coupling *c = m->coupling;
    bough_scheme_report report = bough_scheme_reported(c);
    bool ordered = (c->scheme->reads & BOUGH_READS_ORDER) != 0;
    double steps = m->steps > 0 ? (double)m->steps : 1;
    bough_summary_text(s, "scheme", c->scheme->name);
    const double none = (double)NAN;
    bough_summary_number(s, "order", ordered ? (double)c->options.order : none);
    bough_summary_number(s, "theta",
                         bough_scheme_reads(c->scheme, BOUGH_READS_THETA) ? c->options.theta : none);
    bough_summary_number(s, "interface_ratio", report.interface_ratio);
    bough_summary_number(s, "sweeps_per_step", (double)report.sweeps / steps);
    bough_summary_integer(s, "unfinished_steps", report.unfinished);
    bough_summary_number(s, "macro_step", m->macro_step);
    bough_summary_number(s, "master_rtol", sim->master.rtol);
    bough_summary_number(s, "micro_rtol", sim->micro.rtol);
    bough_summary_integer(s, "threads", bough_pool_threads(run->pool));
    bough_summary_text(s, "kernels", bough_level_name(bough_level_chosen()));
}

static void write_cost(bough_summary *s, const bough_run_command *command) {
    const bough_run *run = &command->run;
    const bough_master *m = run->simulation->master;
    bough_summary_number(s, "duration", m->duration);
    bough_summary_number(s, "time", m->time);
    bough_summary_number(s, "wall_s", run->wall_s);
    bough_summary_number(s, "cpu_s", run->cpu_s);
    bough_summary_number(s, "build_s", command->build_s);
    bough_summary_number(s, "real_time_factor", real_time_factor(run));
    bough_summary_integer(s, "peak_memory_bytes", peak_memory());
    bough_summary_integer(s, "model_bytes", (long long)bough_arena_bytes(command->arena));
}

static void write_size(bough_summary *s, const bough_run_command *command) {
    const bough_run *run = &command->run;
    const bough_simulation *sim = run->simulation;
    bough_summary_integer(s, "bodies", sim->scene->n_body);
    bough_summary_integer(s, "joints", bough_simulation_n_joints(sim));
    bough_summary_integer(s, "states", sim->master->assembly->n_state);
    bough_summary_integer(s, "macro_steps", sim->master->steps);
    bough_summary_integer(s, "rows", bough_recorder_rows(command->recorder));
    bough_summary_integer(s, "channels", command->recorded.count);
}

static void write_control(bough_summary *s, const bough_run *run) {
    const bough_step_control *control = run->simulation->master->control;
    if (!control) return;
    bough_summary_object(s, "step_control");
    bough_summary_number(s, "tolerance", control->tolerance);
    bough_summary_integer(s, "accepted", control->now.accepted);
    bough_summary_integer(s, "rejected", control->now.rejected);
    bough_summary_integer(s, "forced", control->now.forced);
    bough_summary_number(s, "shortest", control->now.shortest);
    bough_summary_end(s);
}

static void write_accuracy(bough_summary *s, const bough_run *run) {
    const bough_master *m = run->simulation->master;
    bough_coupling_report report = bough_monitor_report(m->monitor, m->coupling);
    bough_summary_number(s, "defect_max", report.defect_max);
    bough_summary_number(s, "defect_rms", report.defect_rms);
    bough_summary_number(s, "energy_residual", report.energy_residual);
    bough_summary_number(s, "energy_exchanged", report.energy_exchanged);
}

// A body whose end carries others has two interfaces, that of its root first.
static bool is_far_end(const bough_assembly *a, int interface) {
    bool again = false;
    for (int i = 0; i < interface; i++) again = again || a->pair[i].body == a->pair[interface].body;
    return again;
}

// The energy exchanged at each interface.
static void write_interfaces(bough_summary *s, const bough_run *run) {
    const bough_master *m = run->simulation->master;
    const bough_assembly *a = m->assembly;
    bough_summary_array(s, "interfaces");
    for (int k = 0; k < a->n_pair; k++) {
        bough_pair_energy energy = bough_monitor_energy(m->monitor, k);
        bough_summary_object(s, NULL);
        bough_summary_text(s, "body", a->member[a->pair[k].body]->system.name);
        bough_summary_text(s, "place", is_far_end(a, k) ? "end" : "root");
        bough_summary_number(s, "energy_residual", energy.residual);
        bough_summary_number(s, "energy_exchanged", energy.exchanged);
        bough_summary_end(s);
    }
    bough_summary_end(s);
}

// Statistics of the rows from simulation.output.from on.
static void write_statistics(bough_summary *s, const bough_run_command *command) {
    bough_summary_number(s, "statistics_from", command->run.simulation->scene->simulation.output.from);
    bough_summary_object(s, "statistics");
    for (int k = 0; k < command->recorded.count; k++) {
        const bough_sample_statistics *x = &command->statistics[k];
        if (!(x->n > 0)) continue;
        bough_summary_object(s, command->recorded.channel[k].name);
        bough_summary_text(s, "unit", command->recorded.channel[k].unit);
        bough_summary_text(s, "description", command->recorded.channel[k].meaning);
        bough_summary_number(s, "min", x->least);
        bough_summary_number(s, "max", x->most);
        bough_summary_number(s, "mean", x->mean);
        bough_summary_number(s, "std", bough_sample_statistics_deviation(x));
        bough_summary_end(s);
    }
    bough_summary_end(s);
}

static void write_work(bough_summary *s, const bough_statistics *done) {
    bough_summary_integer(s, "steps", done->steps);
    bough_summary_integer(s, "failed_steps", done->failed_steps);
    bough_summary_integer(s, "derivatives", done->derivatives);
    bough_summary_integer(s, "jacobians", done->jacobians);
    bough_summary_integer(s, "factorisations", done->factorisations);
    bough_summary_integer(s, "iterations", done->iterations);
    bough_summary_integer(s, "starts", done->starts);
}

// The integrator of all bodies together, where the scheme has one.
static void write_whole(bough_summary *s, const bough_run *run) {
    const bough_member *whole = bough_scheme_whole(run->simulation->master->coupling);
    if (whole == NULL) return;
    bough_statistics done = bough_run_statistics(run, run->simulation->master->assembly->n_member);
    bough_summary_object(s, "whole");
    bough_summary_text(s, "solver", whole->solver);
    write_work(s, &done);
    bough_summary_end(s);
}

static void write_member(bough_summary *s, const bough_run *run, int member) {
    const bough_member *m = run->simulation->master->assembly->member[member];
    const bough_member *whole = bough_scheme_whole(run->simulation->master->coupling);
    bough_statistics done = bough_run_statistics(run, member);
    bough_summary_object(s, NULL);
    bough_summary_text(s, "name", m->system.name);
    bough_summary_text(s, "kind", m->system.kind);
    bough_summary_text(s, "solver", whole ? whole->solver : m->solver);
    bough_summary_integer(s, "states", m->system.n_state);
    write_work(s, &done);
    bough_summary_end(s);
}

bough_status bough_run_summarise(const bough_run_command *command) {
    const bough_run *run = &command->run;
    bough_summary s;
    BOUGH_TRY(bough_summary_open(&s, command->folder, "summary.json"));
    write_input(&s, command);
    write_warnings(&s, command);
    write_method(&s, run);
    write_cost(&s, command);
    write_size(&s, command);
    write_control(&s, run);
    write_accuracy(&s, run);
    write_interfaces(&s, run);
    write_verdict(&s, command);
    write_channels(&s, run, "error_estimate", run->companion->error);
    write_shares(&s, command);
    write_statistics(&s, command);
    write_whole(&s, run);
    const bough_assembly *assembly = run->simulation->master->assembly;
    bough_summary_array(&s, "subsystems");
    for (int i = 0; i < assembly->n_member; i++) write_member(&s, run, i);
    bough_summary_end(&s);
    return bough_summary_close(&s);
}

// -- closing lines --------------------------------------------------------------------------------

enum { MOST_LINES = 12, FIRST_FEW = 6, LEAST_DIGITS = 3, MOST_DIGITS = 6 };

// The channels that are printed: main ones of a turbine, or else the first few. Returns their number.
static int main_channels(const bough_run_command *command, int list[MOST_LINES]) {
    static const char *const main_names[] = {"RotSpeed", "GenPwr",  "RtAeroPwr", "RtAeroFxh", "BldPitch1",
                                             "OoPDefl1", "IPDefl1", "RootMyb1",  "TwrBsMyt"};
    enum { MAIN = sizeof main_names / sizeof *main_names };
    const bough_channels *c = &command->recorded;
    int n = 0;
    for (int i = 0; i < MAIN && command->run.simulation->scene->turbine.node; i++) {
        int k = bough_channels_find(c, main_names[i]);
        if (k >= 0) list[n++] = k;
    }
    if (n == 0) {
        while (n < FIRST_FEW && n < c->count) list[n] = n, n++;
    }
    return n;
}

// Number of digits down to the first that the error changes.
static int digits(double largest, double error) {
    if (!(error > 0) || !(largest > 0)) return MOST_DIGITS;
    double n = floor(log10(largest)) - floor(log10(error)) + 1;
    return (int)fmin(fmax(n, LEAST_DIGITS), MOST_DIGITS);
}

static void print_channel(bough_run_command *command, int k) {
    bough_run *run = &command->run;
    const bough_channel *channel = &command->recorded.channel[k];
    const bough_sample_statistics *x = &command->statistics[k];
    int of_run = bough_channels_find(&run->channels, channel->name);
    bool known = bough_companion_knows(run->companion, of_run);
    double error = known ? run->companion->error[of_run] : 0;
    const double value[] = {x->mean, x->least, x->most, bough_run_values(run)[of_run]};
    double largest = fmax(fabs(x->least), fabs(x->most)), rounding = 1e-9 * largest;
    int n = digits(largest, error);
    printf("%-12s %-6s", channel->name, channel->unit);
    for (int i = 0; i < 4; i++) printf(" %11.*g", n, fabs(value[i]) > rounding ? value[i] : 0);
    if (known)
        printf(" %9.2g\n", error);
    else
        printf(" %9s\n", "unknown");
}

// After a failure there are no values.
static void print_channels(bough_run_command *command) {
    const bough_scene_output *output = &command->run.simulation->scene->simulation.output;
    int list[MOST_LINES], n = main_channels(command, list);
    if (!bough_run_values(&command->run) || n == 0 || !(command->statistics[list[0]].n > 0)) return;
    if (output->from > 0) printf("from %.9g s on:\n", output->from);
    printf("%-12s %-6s %11s %11s %11s %11s %9s\n", "channel", "unit", "mean", "min", "max", "end", "error");
    for (int i = 0; i < n; i++) print_channel(command, list[i]);
}

static void print_shares(const bough_run_command *command, int channel) {
    for (int k = 0; k < BOUGH_SHARES && command->shares.found; k++) {
        const bough_error_share *share = &command->shares.share[k];
        if (share->unknown[0]) continue;
        printf("; %s %.2g", bough_error_share_name((bough_error_share_kind)k), share->largest[channel]);
    }
}

static void print_error(const bough_run_command *command) {
    const bough_companion *c = command->run.companion;
    char warning[BOUGH_ERROR_WARNING];
    int worst[WORST], n = bough_error_worst(c, WORST, worst);
    if (c->compared == 0) {
        printf("errors: not estimated: %s\n",
               c->reason[0] ? c->reason : "the run has not reached the companion's first step");
    } else if (n == 0) {
        printf("errors: none: nothing moves\n");
    }
    for (int k = 0; k < n; k++) {
        char error[BOUGH_ERROR_SIZE];
        bough_error_size(c, worst[k], error);
        printf("%s %s %s", k == 0 ? "largest errors:" : "               ",
               c->channels->channel[worst[k]].name, error);
        print_shares(command, worst[k]);
        putchar('\n');
    }
    warn_of_force(&command->run, warning);
    if (command->warning[0]) printf("warning: %s\n", command->warning);
    if (warning[0]) printf("warning: %s\n", warning);
}

// Scene and speed.
static void print_run(const bough_run_command *command) {
    const bough_run *run = &command->run;
    double factor = real_time_factor(run);
    printf("status: %s\n", outcome_name(run));
    printf("run: %.9g s of %s", run->simulation->master->time, run->simulation->scene->file);
    for (int i = 0; i < command->options->common.set.n; i++)
        printf(", %s", command->options->common.set.text[i]);
    printf("\nspeed: %.3g s, %.*f times real time, %.0f MB\n", run->wall_s, factor < 10 ? 2 : 0, factor,
           (double)peak_memory() / 1e6);
    if (!bough_is_ok(&run->outcome)) printf("recorded: %ld rows\n", bough_recorder_rows(command->recorder));
}

static void print_next(const bough_run_command *command) {
    const bough_status *outcome = &command->run.outcome;
    printf("out: %s\n", command->folder);
    if (command->checkpoint.interval > 0 && !bough_is_ok(outcome))
        printf("next: the same command with --resume goes on from the last checkpoint\n");
    else if (outcome->code != BOUGH_IO) // results that could not be written have no report
        printf("next: bough report %s\n", command->folder);
}

void bough_run_report(bough_run_command *command) {
    char warning[BOUGH_ERROR_WARNING];
    print_run(command);
    print_channels(command);
    print_error(command);
    warn_of_steps(&command->run, warning);
    if (warning[0]) printf("warning: %s\n", warning);
    bough_validity_print(command->run.simulation, stdout);
    print_next(command);
}
