/* progress.h - progress and cancellation of long work.
 *
 * A WATCH (struct he_progress) receives the progress of long work and can cancel it. The caller
 * that starts the work owns the watch and lends it: in he_limits.progress while a polygon soup is
 * filled and built, by he_mesh_set_progress for all work on a mesh. Every few thousand elements the
 * work calls the watch's `tell`, whose result says whether to go on. Cancelled work fails with
 * HE_CANCELLED like any other failure: outputs are as they were, memory is freed. The commit of an
 * edit cannot fail, so it reports its progress but cannot be cancelled.
 *
 *     0                                                             1   the whole
 *     |---- span: building ----------------|---- span: summary ----|   he_progress_span
 *     |- pairing -|- linking -|- checking -|- components -|- area -|   he_progress_phase
 *
 * A caller that wants one progress for several calls gives each call a span. Without spans every
 * call would count from 0 to 1, and as reported progress never decreases, it would stay at 1 after
 * the first call. If no span was begun, the span is the whole work. All functions accept a NULL
 * watch and then do nothing.
 *
 * A watch can also lend the threads of its owner to the work (parallel.h). If its `tell` is NULL,
 * it only lends threads: progress is not reported, and the work cannot be cancelled. */
#ifndef HE_BASE_PROGRESS_H
#define HE_BASE_PROGRESS_H

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct he_progress {
    /* Receives progress: `done` from 0 to 1, never less than before; `phase` is the name of the
     * phase, a string that is never freed. Returns false to cancel the work. */
    bool (*tell)(void *context, const char *phase, double done);
    void *context;
    /* the host that lends threads to the work (parallel.h), or NULL */
    const struct he_parallel *parallel;
    const char *phase;
    double span_from, span_to; /* where the span begins and ends, as fractions of the whole work */
    double from, to;           /* where the phase begins and ends, as fractions of the whole work */
    double done;
    bool cancelled;
} he_progress;

void he_progress_init(he_progress *progress,
                      bool (*tell)(void *context, const char *phase, double done), void *context);
/* Begins a span, which lasts until the next one begins. At its end the fraction `to` of the whole
 * work is done. */
void he_progress_span(he_progress *progress, double to);
/* Begins the next phase. At its end the fraction `to` of the span is done.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_progress_phase(he_progress *progress, const char *name, double to,
                                         he_error *err);
/* Reports that step `i` of `count` of the phase is reached.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_progress_step(he_progress *progress, uint64_t i, uint64_t count,
                                        he_error *err);

/* he_progress_at reports like he_progress_step, but only every HE_PROGRESS_STRIDE steps. It is
 * meant for loops of cheap steps. */
enum { HE_PROGRESS_STRIDE = 4096 };
HE_NODISCARD static inline he_status he_progress_at(he_progress *progress, uint64_t i,
                                                    uint64_t count, he_error *err)
{
    return progress == NULL || i % HE_PROGRESS_STRIDE != 0
               ? HE_OK
               : he_progress_step(progress, i, count, err);
}
/* Reports like he_progress_step, but for work that cannot stop at this point, such as a commit: the
 * work goes on even if the watch cancels it. */
void he_progress_tell(he_progress *progress, uint64_t i, uint64_t count);
static inline void he_progress_note(he_progress *progress, uint64_t i, uint64_t count)
{
    if (progress != NULL && i % HE_PROGRESS_STRIDE == 0) {
        he_progress_tell(progress, i, count);
    }
}

#endif
