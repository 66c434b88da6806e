#include "apps/bough/model/fmu_instance.h"

#include <dlfcn.h>
#include <limits.h>
#include <unistd.h>

#if defined __x86_64__
#define PLATFORM "x86_64-linux"
#elif defined __aarch64__
#define PLATFORM "aarch64-linux"
#else
#define PLATFORM "unknown"
#endif

// -- messages -------------------------------------------------------------------------------------

static void receive(fmi3_environment environment, fmi3_status status, fmi3_string category,
                    fmi3_string text) {
    bough_fmu_instance *x = environment;
    (void)category;
    if (status >= FMI3_DISCARD && text) snprintf(x->message, sizeof x->message, "%s", text);
}

bool bough_fmu_is_good(fmi3_status status) { return status == FMI3_OK || status == FMI3_WARNING; }

// The status of a call at t [s]. After an error the standard allows only to release the instance, after a
// fatal error not even that.
static bough_status check_call(bough_fmu_instance *x, const char *function, double t, fmi3_status status) {
    if (bough_fmu_is_good(status)) return bough_ok();
    static const char *const names[] = {"OK", "warning", "discard", "error", "fatal error"};
    const char *name = status <= FMI3_FATAL ? names[status] : "unknown status";
    x->started = false;
    if (status == FMI3_FATAL) x->instance = NULL;
    return bough_fail(BOUGH_FAILED, "%s: the FMU's %s at %.6g s: %s%s%s", x->name, function, t, name,
                      x->message[0] ? ": " : "", x->message);
}

// -- the library ----------------------------------------------------------------------------------

static void release(void *self) {
    bough_fmu_instance *x = self;
    if (x->instance && x->started) x->terminate(x->instance);
    if (x->instance) x->release(x->instance);
    dlclose(x->library);
}

// Sets a pointer to the function of that name; `missing` keeps the first missing name.
static void look_up(const bough_fmu_instance *x, const char *name, void *function, const char **missing) {
    void *symbol = dlsym(x->library, name);
    if (!symbol && !*missing) *missing = name;
    memcpy(function, &symbol, sizeof symbol); // from an object pointer, which POSIX allows
}

static bough_status unusable(const bough_fmu_instance *x, const char *what, const char *detail) {
    return bough_scene_blame(
        x->model->node, "fmu",
        bough_fail(BOUGH_INVALID, "the library of '%.40s' %s %.200s", x->name, what, detail));
}

static bough_status open_library(bough_fmu_instance *x, bough_arena *arena) {
    const bough_fmu_description *d = &x->model->description;
    char path[PATH_MAX];
    const char *missing = NULL;
    const char *folder = x->model->unpacked;
    snprintf(path, sizeof path, "%s%s/binaries/" PLATFORM "/%s.so", strchr(folder, '/') ? "" : "./", folder,
             d->identifier);
    x->library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!x->library) return unusable(x, "cannot be loaded:", dlerror());
    bough_arena_on_destroy(arena, release, x);
    look_up(x, "fmi3InstantiateCoSimulation", &x->instantiate, &missing);
    look_up(x, "fmi3FreeInstance", &x->release, &missing);
    look_up(x, "fmi3EnterInitializationMode", &x->enter, &missing);
    look_up(x, "fmi3ExitInitializationMode", &x->leave, &missing);
    look_up(x, "fmi3Terminate", &x->terminate, &missing);
    look_up(x, "fmi3GetFloat64", &x->get, &missing);
    look_up(x, "fmi3SetFloat64", &x->set, &missing);
    look_up(x, "fmi3DoStep", &x->step, &missing);
    if (d->restores) {
        look_up(x, "fmi3GetFMUState", &x->get_state, &missing);
        look_up(x, "fmi3SetFMUState", &x->set_state, &missing);
        look_up(x, "fmi3FreeFMUState", &x->free_state, &missing);
    }
    return missing ? unusable(x, "has no function", missing) : bough_ok();
}

static bough_status instantiate(bough_fmu_instance *x) {
    const bough_scene_fmu_model *fmu = x->model;
    char here[PATH_MAX] = "", resources[2 * PATH_MAX + 16];
    bool absolute = fmu->unpacked[0] == '/';
    if (!absolute && !getcwd(here, sizeof here)) {
        return bough_fail(BOUGH_IO, "the name of the current folder is not known");
    }
    snprintf(resources, sizeof resources, "%s%s%s/resources/", here, absolute ? "" : "/", fmu->unpacked);
    x->instance = x->instantiate(x->name, fmu->description.token, resources, false, true, false, false, NULL,
                                 0, x, receive, NULL);
    if (!x->instance) return check_call(x, "fmi3InstantiateCoSimulation", 0, FMI3_ERROR);
    size_t n = (size_t)fmu->parameters.n;
    fmi3_status set = n > 0 ? x->set(x->instance, fmu->reference, n, fmu->parameters.value, n) : FMI3_OK;
    return check_call(x, "fmi3SetFloat64", 0, set);
}

// -- values and steps -----------------------------------------------------------------------------

bough_status bough_fmu_open(bough_arena *arena, const bough_scene_fmu_model *model, const char *name,
                            bough_fmu_instance *x) {
    *x = (bough_fmu_instance){.name = name, .model = model};
    BOUGH_TRY(open_library(x, arena));
    return instantiate(x);
}

bough_status bough_fmu_initialise(bough_fmu_instance *x, double t, double end, const bough_fmu_values *inputs,
                                  const double *all) {
    BOUGH_TRY(check_call(x, "fmi3EnterInitializationMode", t, x->enter(x->instance, false, 0, t, true, end)));
    BOUGH_TRY(bough_fmu_set(x, t, inputs, all));
    BOUGH_TRY(check_call(x, "fmi3ExitInitializationMode", t, x->leave(x->instance)));
    x->started = true;
    return bough_ok();
}

bough_status bough_fmu_set(bough_fmu_instance *x, double t, const bough_fmu_values *v, const double *all) {
    size_t n = (size_t)v->n;
    if (n == 0) return bough_ok();
    double value[BOUGH_FMU_VALUES];
    for (size_t k = 0; k < n; k++) value[k] = all[v->quantity[k]];
    return check_call(x, "fmi3SetFloat64", t, x->set(x->instance, v->reference, n, value, n));
}

static const char *name_of(const bough_fmu_description *d, fmi3_reference reference) {
    int k = 0;
    while (k < d->n_variable - 1 && d->variable[k].reference != reference) k++;
    return d->variable[k].name;
}

bough_status bough_fmu_get(bough_fmu_instance *x, double t, const bough_fmu_values *v, double *all) {
    size_t n = (size_t)v->n;
    if (n == 0) return bough_ok();
    double value[BOUGH_FMU_VALUES];
    BOUGH_TRY(check_call(x, "fmi3GetFloat64", t, x->get(x->instance, v->reference, n, value, n)));
    for (size_t k = 0; k < n; k++) {
        all[v->quantity[k]] = value[k];
        if (isfinite(value[k])) continue;
        return bough_fail(BOUGH_FAILED, "%s: output '%.60s' of the FMU at %.6g s: not a finite number",
                          x->name, name_of(&x->model->description, v->reference[k]), t);
    }
    return bough_ok();
}

bough_status bough_fmu_step(bough_fmu_instance *x, double t, double h) {
    bool event = false, terminate = false, early = false;
    double reached = t + h;
    fmi3_status status =
        x->step(x->instance, t, h, !x->model->description.restores, &event, &terminate, &early, &reached);
    BOUGH_TRY(check_call(x, "fmi3DoStep", t, status));
    if (!terminate && !early) return bough_ok();
    return bough_fail(BOUGH_FAILED, "%s: the FMU ended its step at %.6g s, before %.6g s%s", x->name, reached,
                      t + h, terminate ? ": it asks to terminate" : "");
}
