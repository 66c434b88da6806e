// Sessions of a single body, for the FMU; not part of the library's interface.
#ifndef BOUGH_APPS_API_SESSION_BODY_H
#define BOUGH_APPS_API_SESSION_BODY_H

#include "apps/bough/exchange/bough.h"

// A session of the flexible body of that name, whose inputs are the motion of its frame and whose channels
// are the wrench on its carrier: see body_alone.h. NULL: of the whole scene.
bough_session *bough_session_open_body(const char *scene, const char *const *set, int count,
                                       const char *body);

// bough_body_begin of a body's session; nothing of a scene's.
void bough_session_begin_body(bough_session *session);

#endif
