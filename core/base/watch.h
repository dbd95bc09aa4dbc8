/* watch.h - progress and cancellation of long work.
 *
 * A watch receives the progress of long work and can cancel it. The caller that starts the work
 * owns the watch and lends it: in he_limits.watch while a polygon soup is filled and built, by
 * he_mesh_watch for all work on a mesh. Every few thousand elements the work reports its progress
 * to the watch, and the watch answers whether to go on. Cancelled work fails with HE_CANCELLED like
 * any other failure: outputs are as they were, memory is freed. The commit of an edit cannot fail,
 * so it reports its progress but cannot be cancelled.
 *
 *     0                                                             1   the whole
 *     |---- span: building ----------------|---- span: summary ----|   he_watch_span, by the caller
 *     |- pairing -|- linking -|- checking -|- components -|- area -|   he_watch_phase, by the work
 *
 * A caller that wants one progress for several calls gives each call a span. Without spans every
 * call would count from 0 to 1, and as reported progress never decreases, it would stay at 1 after
 * the first call. If no span was begun, the span is the whole. Functions take NULL for a watch and
 * then do nothing.
 *
 * A watch also lends the threads of its owner (exec.h). A watch that lends threads only has no
 * `tell`: progress is not reported, and the work cannot be cancelled. */
#ifndef HE_BASE_WATCH_H
#define HE_BASE_WATCH_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct he_watch {
    /* Receives progress: `done` from 0 to 1, never less than before; `phase` is a string that is
     * never freed. Returns false to cancel the work. */
    bool (*tell)(void *context, const char *phase, double done);
    void *context;
    const struct he_exec *exec; /* threads for the work (exec.h), or NULL */
    const char *phase;
    double span_from, span_to; /* begin and end of the span, as fractions of the whole work */
    double from, to;           /* begin and end of the phase, as fractions of the whole work */
    double done;
    bool cancelled;
} he_watch;

void he_watch_init(he_watch *watch, bool (*tell)(void *context, const char *phase, double done),
                   void *context);
/* Begins a span: the work until the next span begins ends at fraction `to` of the whole work. */
void he_watch_span(he_watch *watch, double to);
/* Begins the next phase, which ends at fraction `to` of its span.
 * Returns HE_CANCELLED if the watch cancelled the work. */
HE_NODISCARD he_status he_watch_phase(he_watch *watch, const char *name, double to, he_error *err);
/* Reports that step `i` of `count` of the phase is reached.
 * Returns HE_CANCELLED if the watch cancelled the work. */
HE_NODISCARD he_status he_watch_step(he_watch *watch, uint64_t i, uint64_t count, he_error *err);

/* Reports like he_watch_step, but only every HE_WATCH_STRIDE steps, for cheap steps in a loop. */
enum { HE_WATCH_STRIDE = 4096 };
HE_NODISCARD static inline he_status he_watch_at(he_watch *watch, uint64_t i, uint64_t count,
                                                 he_error *err)
{
    return watch == NULL || i % HE_WATCH_STRIDE != 0 ? HE_OK : he_watch_step(watch, i, count, err);
}
/* Reports like he_watch_step, but for work that cannot stop at this point, such as a commit: it
 * goes on even if the watch cancels it. */
void he_watch_tell(he_watch *watch, uint64_t i, uint64_t count);
static inline void he_watch_note(he_watch *watch, uint64_t i, uint64_t count)
{
    if (watch != NULL && i % HE_WATCH_STRIDE == 0) {
        he_watch_tell(watch, i, count);
    }
}

#endif
