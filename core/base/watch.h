/* watch.h - how far long work is, and its end before time.
 *
 * Whoever starts long work owns a watch and lends it: he_limits.watch while a soup is filled and
 * built, he_mesh_watch for all that is done with a mesh. The work tells the watch every few
 * thousand elements how far it is, and hears whether to go on. Work that is given up fails with
 * HE_CANCELLED like any other failure: outputs as they were, memory returned. A commit, which
 * cannot fail, only tells.
 *
 *     0                                                             1   the whole
 *     |---- span: building ----------------|---- span: summary ----|   he_watch_span, by the caller
 *     |- pairing -|- linking -|- checking -|- components -|- area -|   he_watch_phase, by the work
 *
 * A caller that wants one number for work of several calls gives each its span; without, every
 * call would count from 0 to 1 and the number would stand still after the first: what is told never
 * falls. A phase without a span has the whole. Functions take NULL for a watch and do nothing.
 *
 * A watch also lends the threads of its owner (exec.h). One that lends threads alone has no `tell`:
 * nobody hears, and the work goes on to its end. */
#ifndef HE_BASE_WATCH_H
#define HE_BASE_WATCH_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct he_watch {
    /* `done` of 1, never less than before; `phase` lives for ever. False: give up. */
    bool (*tell)(void *context, const char *phase, double done);
    void *context;
    const struct he_exec *exec; /* threads for the work (exec.h), or NULL */
    const char *phase;
    double span_from, span_to; /* of the whole */
    double from, to;           /* the phase, of the whole */
    double done;
    bool cancelled;
} he_watch;

void he_watch_init(he_watch *watch, bool (*tell)(void *context, const char *phase, double done),
                   void *context);
/* What follows, up to the next span, takes the work to `to` of the whole. */
void he_watch_span(he_watch *watch, double to);
/* The next phase goes to `to` of its span. HE_CANCELLED. */
HE_NODISCARD he_status he_watch_phase(he_watch *watch, const char *name, double to, he_error *err);
/* Step `i` of `count` of the phase. HE_CANCELLED. */
HE_NODISCARD he_status he_watch_step(he_watch *watch, uint64_t i, uint64_t count, he_error *err);

/* The same where it need not be told of each step. */
enum { HE_WATCH_STRIDE = 4096 };
HE_NODISCARD static inline he_status he_watch_at(he_watch *watch, uint64_t i, uint64_t count,
                                                 he_error *err)
{
    return watch == NULL || i % HE_WATCH_STRIDE != 0 ? HE_OK : he_watch_step(watch, i, count, err);
}
/* For work that cannot stop here, such as a commit. */
void he_watch_tell(he_watch *watch, uint64_t i, uint64_t count);
static inline void he_watch_note(he_watch *watch, uint64_t i, uint64_t count)
{
    if (watch != NULL && i % HE_WATCH_STRIDE == 0) {
        he_watch_tell(watch, i, count);
    }
}

#endif
