#include "build/soup_check.h"

#include <string.h>

void he_report_add(he_report *report, uint64_t *total, he_defect defect)
{
    if (report != NULL && *total < HE_REPORT_DEFECTS) {
        report->defects[*total] = defect;
    }
    ++*total;
    if (report != NULL) {
        report->total = *total;
    }
}

static he_defect face_defect(he_status reason, size_t face, uint32_t corner, uint32_t vertex)
{
    return (he_defect){reason, HE_FACE, (uint32_t)face, corner, vertex, HE_NONE};
}

uint32_t he_soup_find_repeat(const uint32_t *corners, uint32_t count, uint32_t *stamp,
                             uint32_t mark)
{
    if (count <= HE_SMALL_FACE) {
        for (uint32_t i = 1; i < count; i++) {
            for (uint32_t k = 0; k < i; k++) {
                if (corners[i] == corners[k]) {
                    return i;
                }
            }
        }
        return count;
    }
    for (uint32_t i = 0; i < count; i++) {
        if (stamp[corners[i]] == mark) {
            return i;
        }
        stamp[corners[i]] = mark;
    }
    return count;
}

he_status he_soup_check_faces(const he_soup *soup, he_report *report, uint64_t *total,
                              he_error *err)
{
    uint32_t *stamp = NULL;
    he_status status = HE_OK;
    for (size_t f = 0; f < soup->face_count; f++) {
        status = he_progress_at(soup->limits.progress, f, soup->face_count, err);
        if (status != HE_OK) {
            break;
        }
        uint32_t count = he_soup_end(soup, f) - soup->starts[f], k = 0;
        if (count < 3) {
            he_report_add(report, total, face_defect(HE_TOO_FEW_CORNERS, f, HE_NONE, HE_NONE));
        }
        if (count == 0) {
            continue; /* a soup without corners may have no array of corners */
        }
        const uint32_t *corners = soup->corners + soup->starts[f];
        while (k < count && corners[k] < soup->vertex_count) {
            k++;
        }
        if (k < count) {
            he_report_add(report, total, face_defect(HE_BAD_INDEX, f, k, corners[k]));
            continue;
        }
        if (count > HE_SMALL_FACE && stamp == NULL) {
            stamp = he_mem_zero(soup->vertex_count, sizeof *stamp);
            if (stamp == NULL) {
                return he_fail_plain(err, HE_NO_MEMORY, "no memory to check the faces");
            }
        }
        k = he_soup_find_repeat(corners, count, stamp, (uint32_t)f + 1);
        if (k < count) {
            he_report_add(report, total, face_defect(HE_REPEATED_CORNER, f, k, corners[k]));
        }
    }
    he_mem_free(stamp);
    return status;
}

/* A corner, sorted into the list of a vertex. The half-edge of the corner runs to the next corner
 * of its face; the list is that of the end with the smaller id. `far` is the id of the opposite
 * end; its top bit is set if the half-edge begins there. */
typedef struct filed {
    uint32_t far, corner;
} filed;

#define DOWNWARD 0x80000000u

/* Sorts all corners by that end of their half-edge which has the smaller id. Afterwards the entries
 * of vertex v begin at starts[v] and end before starts[v + 1]. */
static he_status file_corners(const he_soup *soup, uint32_t *starts, filed *entries, he_error *err)
{
    const size_t faces = soup->face_count;
    const uint32_t *corners = soup->corners;
    memset(starts, 0, (soup->vertex_count + 2) * sizeof *starts);
    uint32_t *counts = starts + 2;
    he_status status = HE_OK;
    for (size_t f = 0; f < faces && status == HE_OK; f++) {
        uint32_t end = he_soup_end(soup, f), a = corners[end - 1];
        status = he_progress_at(soup->limits.progress, f, 3 * faces, err);
        for (uint32_t c = soup->starts[f]; c < end; c++) {
            uint32_t b = corners[c];
            counts[(a < b ? a : b)]++;
            a = b;
        }
    }
    for (size_t v = 2; v < soup->vertex_count + 2; v++) {
        starts[v] += starts[v - 1];
    }
    uint32_t *place = starts + 1;
    for (size_t f = 0; f < faces && status == HE_OK; f++) {
        status = he_progress_at(soup->limits.progress, f + faces, 3 * faces, err);
        uint32_t first = soup->starts[f], end = he_soup_end(soup, f);
        for (uint32_t c = first; c < end; c++) {
            uint32_t a = corners[c], b = corners[c + 1 < end ? c + 1 : first];
            bool up = a < b;
            entries[place[up ? a : b]++] = (filed){up ? b : a | DOWNWARD, c};
        }
    }
    return status;
}

typedef struct pairing {
    const he_soup *soup;
    /* for each corner the corner of the adjacent face along its edge; NULL if edges are numbered
     * instead */
    uint32_t *mate;
    uint32_t *edge; /* id of each corner's edge, if edges are numbered */
    size_t edges;
    he_report *report;
    uint64_t *total;
} pairing;

/* Begins a new edge; entry `a` is its first corner. */
static void begin_edge(pairing *p, const filed *a)
{
    if (p->mate == NULL) {
        p->edge[a->corner] = (uint32_t)p->edges;
    }
    p->edges++;
}

/* Makes the corners of entries `a` and `b` mates; they are along one edge, and `a` is the first
 * corner there. If edges are numbered instead, assigns the id of this edge to the corner of `b`. */
static void pair_up(pairing *p, uint32_t low, const filed *a, const filed *b)
{
    uint32_t far = b->far & ~DOWNWARD;
    if (p->mate == NULL) {
        p->edge[b->corner] = p->edge[a->corner];
        return;
    }
    if (p->mate[a->corner] != HE_NONE) {
        he_report_add(p->report, p->total,
                      (he_defect){HE_NONMANIFOLD_EDGE, HE_FACE, he_soup_face_of(p->soup, b->corner),
                                  HE_NONE, low, far});
        return;
    }
    p->mate[a->corner] = b->corner;
    p->mate[b->corner] = a->corner;
    if (((a->far ^ b->far) & DOWNWARD) == 0) {
        he_report_add(p->report, p->total,
                      (he_defect){HE_ORIENTATION, HE_FACE, he_soup_face_of(p->soup, b->corner),
                                  HE_NONE, low, far});
    }
}

enum { SMALL_BUCKET = 24 };

static void pair_small(pairing *p, uint32_t low, const filed *entries, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t k = 0;
        while (k < i && ((entries[k].far ^ entries[i].far) & ~DOWNWARD) != 0) {
            k++;
        }
        if (k < i) {
            pair_up(p, low, &entries[k], &entries[i]);
        } else {
            begin_edge(p, &entries[i]);
        }
    }
}

/* Finds the corners that are along one edge, at a vertex `low` of high degree, whose entries begin
 * at starts[low] and end before starts[low + 1]. first[v] is the first entry of `low` whose edge
 * leads to vertex v. It may also be an entry of a vertex that was handled earlier, but such an
 * entry is outside this range, so the array needs no clearing. */
static void pair_large(pairing *p, uint32_t low, const filed *entries, const uint32_t *starts,
                       uint32_t *first)
{
    const uint32_t begin = starts[low], end = starts[low + 1];
    for (uint32_t i = begin; i < end; i++) {
        uint32_t far = entries[i].far & ~DOWNWARD, k = first[far];
        if (k >= begin && k < i && (entries[k].far & ~DOWNWARD) == far) {
            pair_up(p, low, &entries[k], &entries[i]);
        } else {
            first[far] = i;
            begin_edge(p, &entries[i]);
        }
    }
}

static he_status no_memory(const he_soup *soup, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory to find the edges of %zu corners",
                         soup->corner_count);
}

/* Visits all edges in the order of the vertices, and finds the mates of their corners or numbers
 * the edges. */
static he_status visit_edges(pairing *p, he_error *err)
{
    const he_soup *soup = p->soup;
    he_status status = HE_OK;
    const size_t vertices = soup->vertex_count;
    uint32_t *starts = he_mem_array(NULL, soup->vertex_count + 2, sizeof *starts);
    filed *entries = he_mem_array(NULL, soup->corner_count, sizeof *entries);
    uint32_t *first = NULL;
    if (starts == NULL || entries == NULL) {
        status = no_memory(soup, err);
        goto out;
    }
    status = file_corners(soup, starts, entries, err);
    if (status != HE_OK) {
        goto out;
    }
    enum { AHEAD = 24 };
    const uint32_t *written = p->mate != NULL ? p->mate : p->edge;
    for (size_t v = 0; v < vertices; v++) {
        uint32_t begin = starts[v], end = starts[v + 1];
        status = he_progress_at(soup->limits.progress, v + 2 * vertices, 3 * vertices, err);
        if (status != HE_OK) {
            goto out;
        }
        /* The words of `written` that the loop will write are prefetched: if the ids of vertices
         * are in no spatial order, these words lie far apart. */
        for (uint32_t i = begin; i < end && soup->corner_count - i > AHEAD; i++) {
            __builtin_prefetch(&written[entries[i + AHEAD].corner], 1);
        }
        if (end - begin <= SMALL_BUCKET) {
            pair_small(p, (uint32_t)v, entries + begin, end - begin);
            continue;
        }
        if (first == NULL) {
            first = he_mem_zero(soup->vertex_count, sizeof *first);
            if (first == NULL) {
                status = no_memory(soup, err);
                goto out;
            }
        }
        pair_large(p, (uint32_t)v, entries, starts, first);
    }
out:
    he_mem_free(starts);
    he_mem_free(entries);
    he_mem_free(first);
    return status;
}

he_status he_soup_check_edges(const he_soup *soup, he_report *report, uint64_t *total,
                              he_error *err)
{
    pairing p = {.soup = soup, .report = report, .total = total};
    p.mate = he_mem_array(NULL, soup->corner_count, sizeof *p.mate);
    if (p.mate == NULL) {
        return no_memory(soup, err);
    }
    for (size_t c = 0; c < soup->corner_count; c++) {
        p.mate[c] = HE_NONE;
    }
    he_status status = visit_edges(&p, err);
    he_mem_free(p.mate);
    return status;
}

he_status he_soup_number_edges(const he_soup *soup, uint32_t *edge, size_t *edges, he_error *err)
{
    pairing p = {.soup = soup, .edge = edge};
    he_status status = visit_edges(&p, err);
    if (status == HE_OK) {
        *edges = p.edges;
    }
    return status;
}
