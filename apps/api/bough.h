/* bough as a library: opens a scene, steps it, reads its channels, keeps copies of its state. One
   session is used by one thread at a time; any number of sessions may live, and run, at once. Needs
   nothing else of bough's headers.

       bough_session *s = bough_session_open("runup.yaml", NULL, 0);
       int speed = bough_session_find(s, "RotSpeed");
       while (bough_session_step(s) == BOUGH_SESSION_OK)
           printf("%g %g\n", bough_session_time(s), bough_session_read(s, speed));
       if (bough_session_error(s)[0]) fprintf(stderr, "%s\n", bough_session_error(s));
       bough_session_close(s);
*/
#ifndef BOUGH_H
#define BOUGH_H

#include <stddef.h>

#if defined BOUGH_API
/* as given */
#elif defined __GNUC__
#define BOUGH_API __attribute__((visibility("default")))
#else
#define BOUGH_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bough_session bough_session;

/* The codes are those that the program ends with. */
enum {
    BOUGH_SESSION_OK = 0,      /* a macro step was taken, a copy made */
    BOUGH_SESSION_DONE = -1,   /* the scene's duration is reached: nothing was done */
    BOUGH_SESSION_INVALID = 2, /* the scene or the copy is not valid */
    BOUGH_SESSION_FAILED = 3,  /* numerical failure; the session can only be restored or closed */
    BOUGH_SESSION_OTHER = 1,   /* a file, memory */
};

/* Reads and builds a scene with `count` replacements "key=value" (NULL: none). Never NULL but when
   there is no memory at all: whether it worked is told by bough_session_code. */
BOUGH_API bough_session *bough_session_open(const char *scene, const char *const *set, int count);

/* How the last open, step, save or restore ended, and why if it failed: one or more lines, "" after
   success. */
BOUGH_API int bough_session_code(const bough_session *session);
BOUGH_API const char *bough_session_error(const bough_session *session);

/* A warning about the scene's coupling, or "". */
BOUGH_API const char *bough_session_warning(const bough_session *session);

/* Takes one macro step. */
BOUGH_API int bough_session_step(bough_session *session);

/* Time now and at the end [s]; NaN when the scene could not be opened. */
BOUGH_API double bough_session_time(const bough_session *session);
BOUGH_API double bough_session_duration(const bough_session *session);

/* Channels, as in channels.out: their number, names, units, the index of a name (-1: none), the
   value now (NaN when there is no such channel). The first read after a step computes all. */
BOUGH_API int bough_session_count(const bough_session *session);
BOUGH_API const char *bough_session_name(const bough_session *session, int channel);
BOUGH_API const char *bough_session_unit(const bough_session *session, int channel);
BOUGH_API int bough_session_find(const bough_session *session, const char *name);
BOUGH_API double bough_session_read(bough_session *session, int channel);

/* All of them (count), always at the same place; NULL when there are none or a step has failed. */
BOUGH_API const double *bough_session_values(bough_session *session);

/* Inputs: what the scene leaves to the caller ('input: NAME' of a load, of a joint's motion, of the
   wind; 'control: {kind: external}'). Their number, names, units (SI), the index of a name (-1:
   none), the value now (NaN when there is no such input). */
BOUGH_API int bough_session_inputs(const bough_session *session);
BOUGH_API const char *bough_session_input_name(const bough_session *session, int input);
BOUGH_API const char *bough_session_input_unit(const bough_session *session, int input);
BOUGH_API int bough_session_input(const bough_session *session, const char *name);
BOUGH_API double bough_session_input_value(const bough_session *session, int input);

/* Sets an input from the next step on, in SI, or as text with any unit that fits ("40 kN m"). A load
   and the wind have the value from the step's beginning, a joint is there at its end; what is
   demanded as control is sampled at the control's rate. BOUGH_SESSION_INVALID: no such input, no
   finite number, a wrong unit; nothing is changed. */
BOUGH_API int bough_session_set(bough_session *session, int input, double value);
BOUGH_API int bough_session_set_text(bough_session *session, int input, const char *value);

/* Copies of all that a session goes on from, of `size` bytes (0: not opened), in the caller's
   memory, aligned as malloc aligns; good until the process ends.

   Integrators start anew where a copy is made, in the session that goes on as in one that is
   restored: both go on to the same bits. Restored may be any session whose scene has the same
   parts, coupling and macro step, also after a failed step; other values in its scene, a wind or a
   stiffness, make it a what-if from that moment on.

   BOUGH_SESSION_INVALID, and the session is as it was: a copy of another kind of scene; between two
   samples of the air or the control, whose past is not in a copy: step on; a controller's library,
   whose memory is its own. */
BOUGH_API size_t bough_session_size(const bough_session *session);
BOUGH_API int bough_session_save(bough_session *session, void *copy);
BOUGH_API int bough_session_restore(bough_session *session, const void *copy);

BOUGH_API void bough_session_close(bough_session *session);

#ifdef __cplusplus
}
#endif

#endif
