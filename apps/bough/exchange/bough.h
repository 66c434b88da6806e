/* bough as a library: opens a scene, steps it, sets its inputs, reads its channels and stores copies of
   its state. Only one thread at a time may use a session; any number of sessions may exist and run in
   parallel. This header needs no other header of bough.

   Every function accepts any session, also NULL and one whose scene could not be opened: then there are no
   channels, inputs and values, and a call that returns a code returns that of the opening.

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

/* The codes from 1 on are also the exit codes of the program. */
enum {
    BOUGH_SESSION_OK = 0,      /* a macro step was taken, a copy made */
    BOUGH_SESSION_DONE = -1,   /* the scene's duration is reached: nothing was done */
    BOUGH_SESSION_INVALID = 2, /* the scene or the copy is not valid */
    BOUGH_SESSION_FAILED = 3,  /* numerical failure; the session can only be restored or closed */
    BOUGH_SESSION_OTHER = 1,   /* a file, memory */
};

/* Reads and builds a scene with `count` replacements "key=value" (NULL: none). Returns NULL only if
   memory is exhausted; bough_session_code states whether the scene was built. */
BOUGH_API bough_session *bough_session_open(const char *scene, const char *const *set, int count);

/* The same with the values of the inputs at time 0 (one for each input, SI; NULL: those of the scene). The
   state at time 0 follows from them: loads, wind, joints with an input as motion, an equilibrium. */
BOUGH_API bough_session *bough_session_open_with(const char *scene, const char *const *set, int count,
                                                 const double *input);

/* Code of the last open, step, save, restore, set or failed search of a name, and the message of a failure:
   one or more lines, "" after success. */
BOUGH_API int bough_session_code(const bough_session *session);
BOUGH_API const char *bough_session_error(const bough_session *session);

/* A warning about the scene's coupling, or "". */
BOUGH_API const char *bough_session_warning(const bough_session *session);

/* Takes one macro step. After one that has failed, the same code and message again. */
BOUGH_API int bough_session_step(bough_session *session);

/* Time now, at the end, and of one macro step [s]; NaN when the scene could not be opened. */
BOUGH_API double bough_session_time(const bough_session *session);
BOUGH_API double bough_session_duration(const bough_session *session);
BOUGH_API double bough_session_macro_step(const bough_session *session);

/* Channels, as in channels.out: number of channels, name, unit, index of a name (-1: no such channel; the
   message names the nearest), current value (NaN: no such channel). The first read after a step computes all
   values. */
BOUGH_API int bough_session_count(const bough_session *session);
BOUGH_API const char *bough_session_name(const bough_session *session, int channel);
BOUGH_API const char *bough_session_unit(const bough_session *session, int channel);
BOUGH_API int bough_session_find(bough_session *session, const char *name);
BOUGH_API double bough_session_read(bough_session *session, int channel);

/* Current values of all channels (count), at an address that does not change; NULL if there are no
   channels or a step has failed. */
BOUGH_API const double *bough_session_values(bough_session *session);

/* Estimated largest error of a channel so far, in its unit, where the scene or a replacement says
   'simulation.error_estimate: companion'; NaN: not known. */
BOUGH_API double bough_session_estimate(const bough_session *session, int channel);

/* Poses: number of bodies, in the scene's order, name of one ("": no such body), number of its stations (0:
   no such body): the vertices of a rod from its root to its end, of any other body its origin alone. */
BOUGH_API int bough_session_bodies(const bough_session *session);
BOUGH_API const char *bough_session_body_name(const bough_session *session, int body);
BOUGH_API int bough_session_stations(const bough_session *session, int body);

/* Where a body is now: position (stations × 3) [m] and rotation matrix, row by row (stations × 3 × 3), of
   each station in ground axes; the matrix takes components in the axes of body or section to those in ground
   axes. BOUGH_SESSION_INVALID: no such body; BOUGH_SESSION_FAILED: a step has failed. */
BOUGH_API int bough_session_poses(bough_session *session, int body, double *position, double *rotation);

/* Inputs, which the scene declares ('input: NAME' of a load, of a joint's motion, of the wind;
   'control: {kind: external}'): number of inputs, name, unit (SI), index of a name (-1: no such input; the
   message names the nearest), current value (NaN: no such input). */
BOUGH_API int bough_session_inputs(const bough_session *session);
BOUGH_API const char *bough_session_input_name(const bough_session *session, int input);
BOUGH_API const char *bough_session_input_unit(const bough_session *session, int input);
BOUGH_API int bough_session_input(bough_session *session, const char *name);
BOUGH_API double bough_session_input_value(const bough_session *session, int input);

/* Sets an input from the next step on, in SI, or as text with any suitable unit ("40 kN m"). Loads have
   the value from the beginning of the step, the wind from the next sample of the air; a joint reaches
   the value at the end of the step; demands of the control are sampled at the rate of the control.
   BOUGH_SESSION_INVALID: no such input, not a finite number, a wrong unit, or a value that the scene would
   refuse, such as wind of a negative speed; nothing is changed. */
BOUGH_API int bough_session_set(bough_session *session, int input, double value);
BOUGH_API int bough_session_set_text(bough_session *session, int input, const char *value);

/* Copies of a session's state, of `size` bytes (0: the scene was not opened), in memory of the caller with
   the alignment of malloc. A copy is valid until the process ends.

   Integrators restart where a copy is made, in the session itself and in a restored session, so both
   continue to identical results. A copy may be restored into any session whose scene has the same
   parts, coupling and macro step, also after a failed step. The scene may have other values, such as
   another wind or stiffness, and then shows what changes from that moment on.

   BOUGH_SESSION_INVALID, with the session unchanged: the copy belongs to another kind of scene; the time
   is between two samples of the air or the control, of a companion half as many (take further steps first);
   the scene has a controller's library, whose memory cannot be copied. */
BOUGH_API size_t bough_session_size(const bough_session *session);
BOUGH_API int bough_session_save(bough_session *session, void *copy);
BOUGH_API int bough_session_restore(bough_session *session, const void *copy);

BOUGH_API void bough_session_close(bough_session *session);

#ifdef __cplusplus
}
#endif

#endif
