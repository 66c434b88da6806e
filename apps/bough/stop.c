#include "apps/bough/stop.h"

#include <signal.h>
#include <stddef.h>

// A signal handler can reach nothing but a global.
static volatile sig_atomic_t requested; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

static void request(int signal_number) {
    (void)signal_number;
    requested = 1;
}

void bough_stop_listen(void) {
    struct sigaction action = {.sa_handler = request, .sa_flags = SA_RESTART | (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

bool bough_stop_requested(void) { return requested != 0; }
