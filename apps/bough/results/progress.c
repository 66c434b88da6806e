#include "apps/bough/results/progress.h"

#include <stdio.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

static double read_clock(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double bough_wall_clock(void) { return read_clock(CLOCK_MONOTONIC); }

double bough_cpu_clock(bool thread) {
    return read_clock(thread ? CLOCK_THREAD_CPUTIME_ID : CLOCK_PROCESS_CPUTIME_ID);
}

bough_progress bough_progress_start(double t, double t_end, bool quiet) {
    double now = bough_wall_clock();
    return (bough_progress){.visible = !quiet && isatty(STDERR_FILENO) == 1,
                            .start = t,
                            .end = t_end,
                            .began = now,
                            .shown = now};
}

enum { TIMES = 24 }; // characters of the times after a label

void bough_progress_text(const bough_progress *p, double t, double wall, int room, char *text, size_t size) {
    int name = room > TIMES ? room - TIMES : 0;
    double done = t - p->start;
    if (p->label) {
        snprintf(text, size, "%-*.*s %8.2f of %.6g s", name, name, p->label, t, p->end);
        return;
    }
    int length = snprintf(text, size, "%.2f of %.6g s", t, p->end);
    if (done <= 0 || wall <= 0 || length >= (int)size) return;
    double left = (p->end - t) * wall / done;
    long seconds = left < 1e8 ? (long)(left + 0.5) : 99999999L;
    snprintf(text + length, size - (size_t)length, ", %.3g times real time, %ld:%02ld left", done / wall,
             seconds / 60, seconds % 60);
}

// Characters of the line: one less than the terminal has, whose last would break it.
static int width(void) {
    enum { USUAL = 72 };
    struct winsize size;
    bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
    return known && size.ws_col <= USUAL ? size.ws_col - 1 : USUAL;
}

void bough_progress_show(bough_progress *p, double t) {
    if (!p->visible) return;
    double now = bough_wall_clock();
    if (now - p->shown < 0.1) return;
    p->shown = now;
    char text[128];
    int room = width();
    bough_progress_text(p, t, now - p->began, room, text, sizeof text);
    fprintf(stderr, "\r%-*.*s", room, room, text);
    fflush(stderr);
}

void bough_progress_clear(const bough_progress *p) {
    if (p->visible) fprintf(stderr, "\r%*s\r", width(), "");
}
