#include "apps/bough/cli/command.h"

#include <signal.h>

// A signal handler can reach nothing but a global.
static volatile sig_atomic_t requested; // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

static void request(int signal_number) {
    (void)signal_number;
    requested = 1;
}

// A limit of processor time is signalled once more for every further second until the hard limit. `nohup`
// starts a program with SIGHUP ignored, which then stays so.
static const struct {
    int number;
    bool repeated; // a second one asks for the same, and does not end the process
    bool ignorable;
} signals[] = {
    {SIGINT, false, false}, {SIGTERM, false, false}, {SIGHUP, false, true}, {SIGXCPU, true, false}};

static bool is_ignored(int number) {
    struct sigaction now;
    return sigaction(number, NULL, &now) == 0 && now.sa_handler == SIG_IGN;
}

void bough_stop_listen(void) {
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        if (signals[i].ignorable && is_ignored(signals[i].number)) continue;
        int once = signals[i].repeated ? 0 : (int)SA_RESETHAND;
        struct sigaction action = {.sa_handler = request, .sa_flags = SA_RESTART | once};
        sigemptyset(&action.sa_mask);
        sigaction(signals[i].number, &action, NULL);
    }
    signal(SIGPIPE, SIG_IGN); // who reads the messages may end before the run does
}

bool bough_stop_requested(void) { return requested != 0; }
