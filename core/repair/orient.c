/* orient.c - the repair orient: reverses faces so that any two faces that share an edge run along
 * it in opposite directions. It is a breadth-first search from face to face, across edges that have
 * exactly two faces, one component after another. */
#include "build/soup_check.h"
#include "repair/mend.h"

typedef enum state { UNSEEN, KEPT, TURNED } state;

typedef struct orienting {
    he_soup *soup;
    he_repaired *out;
    /* The mate of each corner, which is the corner of the adjacent face whose half-edge runs along
     * this edge; HE_NONE unless the edge has exactly two faces. */
    uint32_t *mate;
    uint32_t *face_of; /* face of each corner */
    uint32_t *queue;   /* the faces in the order of the search, component after component */
    unsigned char *state;
} orienting;

#define NO_PAIR (HE_NONE - 1)

/* Finds the mate of each corner: if the edge along which the corner's half-edge runs has exactly
 * two corners, the mate is the second corner. */
static he_status find_mates(orienting *o, he_error *err)
{
    const he_soup *soup = o->soup;
    size_t edges = 0;
    /* The memory of `face_of` is used for another array until `face_of` is filled. */
    uint32_t *edge_of = o->face_of;
    he_status status = he_soup_number_edges(soup, edge_of, &edges, err);
    if (status != HE_OK) {
        return status;
    }
    uint32_t *met = he_mem_zero(
        /* The number of corners of each edge; later its first corner if it has two. */
        edges + 1, sizeof *met);
    if (met == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory to orient %zu faces", soup->face_count);
    }
    for (size_t c = 0; c < soup->corner_count; c++) {
        met[edge_of[c]]++;
    }
    for (size_t e = 0; e < edges; e++) {
        met[e] = met[e] == 2 ? HE_NONE : NO_PAIR;
    }
    for (uint32_t c = 0; c < soup->corner_count; c++) {
        uint32_t *first = &met[edge_of[c]];
        o->mate[c] = HE_NONE;
        if (*first == HE_NONE) {
            *first = c;
        } else if (*first != NO_PAIR) {
            o->mate[c] = *first;
            o->mate[*first] = c;
        }
    }
    he_mem_free(met);
    return HE_OK;
}

/* Records that a component cannot be oriented consistently: face f and its neighbour would run in
 * one direction along the edge at corner c. */
static void note_clash(orienting *o, uint32_t f, uint32_t c)
{
    const he_soup *soup = o->soup;
    he_repair_account *account = &o->out->accounts[HE_REPAIR_ORIENT];
    uint32_t end = he_soup_end(soup, f);
    if (account->left < HE_REPAIR_NAMED) {
        o->out->clashes[account->left] = (he_repair_clash){
            f, soup->corners[c], soup->corners[c + 1 < end ? c + 1 : soup->starts[f]]};
    }
    account->left++;
}

/* Adds to the queue the component of the face `seed`: all faces that can be reached from it across
 * edges. Decides for each face whether it must be reversed so that its orientation agrees with that
 * of `seed`. Sets *fits to false if the faces cannot be oriented consistently. */
static he_status walk(orienting *o, uint32_t seed, uint32_t *end, bool *fits, he_error *err)
{
    const he_soup *soup = o->soup;
    he_status status = HE_OK;
    uint32_t begin = *end;
    o->queue[(*end)++] = seed;
    o->state[seed] = KEPT;
    *fits = true;
    for (uint32_t i = begin; i < *end && status == HE_OK; i++) {
        uint32_t f = o->queue[i], last = he_soup_end(soup, f);
        status = he_progress_at(soup->limits.progress, i, soup->face_count, err);
        for (uint32_t c = soup->starts[f]; c < last; c++) {
            uint32_t mate = o->mate[c];
            if (mate == HE_NONE) {
                continue;
            }
            uint32_t g = o->face_of[mate];
            bool same = soup->corners[mate] == soup->corners[c];
            unsigned char wanted = (o->state[f] == KEPT) == same ? TURNED : KEPT;
            if (o->state[g] == UNSEEN) {
                o->state[g] = wanted;
                o->queue[(*end)++] = g;
            } else if (o->state[g] != wanted && *fits) {
                *fits = false;
                note_clash(o, f, c);
            }
        }
    }
    return status;
}

/* Counts the clashes, which are edges along which two faces run in one direction, of the faces
 * queue[begin] to queue[end - 1]. If `turned` is true, faces count as reversed where `state` says
 * so; if it is false, no face counts as reversed. Each clash is counted twice, once for each of its
 * two faces. */
static uint64_t clashes_of(const orienting *o, uint32_t begin, uint32_t end, bool turned)
{
    const he_soup *soup = o->soup;
    uint64_t count = 0;
    for (uint32_t i = begin; i < end; i++) {
        uint32_t f = o->queue[i], last = he_soup_end(soup, f);
        for (uint32_t c = soup->starts[f]; c < last; c++) {
            uint32_t mate = o->mate[c];
            if (mate == HE_NONE) {
                continue;
            }
            bool same = soup->corners[mate] == soup->corners[c];
            bool differ = o->state[f] != o->state[o->face_of[mate]];
            count += turned ? same != differ : same;
        }
    }
    return count;
}

/* Decides which faces of a component are reversed that cannot be oriented consistently. If
 * reversing faces would not reduce the number of clashes (edges along which two faces run in one
 * direction), no face is reversed. */
static void settle_clashing(orienting *o, uint32_t begin, uint32_t end)
{
    if (clashes_of(o, begin, end, true) < clashes_of(o, begin, end, false)) {
        return;
    }
    for (uint32_t i = begin; i < end; i++) {
        o->state[o->queue[i]] = KEPT;
    }
}

/* The search has divided the faces of a component, queue[begin] to queue[end - 1], into two sets.
 * Reversing either set orients the component; this function chooses the smaller set. */
static void settle(orienting *o, uint32_t begin, uint32_t end)
{
    uint32_t turned = 0;
    for (uint32_t i = begin; i < end; i++) {
        turned += o->state[o->queue[i]] == TURNED;
    }
    if (turned > (end - begin) / 2) {
        for (uint32_t i = begin; i < end; i++) {
            uint32_t f = o->queue[i];
            o->state[f] = o->state[f] == TURNED ? KEPT : TURNED;
        }
        turned = end - begin - turned;
    }
    o->out->accounts[HE_REPAIR_ORIENT].parts += turned > 0;
}

/* Reverses a face: its first corner stays first, and the order of the other corners is reversed. */
static void turn(he_mend *m, uint32_t f)
{
    uint32_t low = m->soup->starts[f] + 1, high = he_soup_end(m->soup, f) - 1;
    for (; low < high; low++, high--) {
        uint32_t corner = m->soup->corners[low];
        m->soup->corners[low] = m->soup->corners[high];
        m->soup->corners[high] = corner;
        if (m->corner_from != NULL) {
            uint32_t from = m->corner_from[low];
            m->corner_from[low] = m->corner_from[high];
            m->corner_from[high] = from;
        }
    }
}

static he_status turn_all(he_mend *m, const unsigned char *states, he_error *err)
{
    he_repair_account *account = &m->out->accounts[HE_REPAIR_ORIENT];
    he_status status = account->parts > 0 ? he_mend_corners(m, err) : HE_OK;
    if (status == HE_OK && account->parts > 0) {
        m->turned = he_bits_new(m->soup->face_count);
        status = m->turned != NULL
                     ? HE_OK
                     : he_fail_plain(err, HE_NO_MEMORY, "no memory to reverse %zu faces",
                                     m->soup->face_count);
    }
    for (uint32_t f = 0; f < m->soup->face_count && status == HE_OK; f++) {
        if (states[f] == TURNED) {
            turn(m, f);
            he_bits_set(m->turned, f);
            account->count++;
            he_mend_name(account, f, HE_NONE);
        }
    }
    return status;
}

static he_status refuse(const he_mend *m, he_error *err)
{
    const he_repair_clash *c = &m->out->clashes[0];
    uint32_t f = he_mend_input(m->out->face_from, c->face);
    return he_fail(err, HE_NOT_ORIENTABLE, HE_FACE, f,
                   "face %u at the edge from vertex %u to %u: the faces around this place cannot "
                   "be oriented consistently, as on a Moebius strip",
                   f, he_mend_input(m->out->vertex_from, c->vertex),
                   he_mend_input(m->out->vertex_from, c->other));
}

he_status he_mend_orient(he_mend *m, bool force, he_error *err)
{
    he_soup *soup = m->soup;
    orienting o = {.soup = soup, .out = m->out};
    he_status status = HE_OK;
    o.mate = he_mem_array(NULL, soup->corner_count, sizeof *o.mate);
    o.face_of = he_mem_array(NULL, soup->corner_count, sizeof *o.face_of);
    o.queue = he_mem_array(NULL, soup->face_count, sizeof *o.queue);
    o.state = he_mem_zero(soup->face_count + 1, sizeof *o.state);
    if (o.mate == NULL || o.face_of == NULL || o.queue == NULL || o.state == NULL) {
        status =
            he_fail_plain(err, HE_NO_MEMORY, "no memory to orient %zu faces", soup->face_count);
        goto out;
    }
    status = find_mates(&o, err);
    if (status != HE_OK) {
        goto out;
    }
    he_mend_faces(soup, o.face_of);
    uint32_t end = 0;
    for (uint32_t f = 0; f < soup->face_count && status == HE_OK; f++) {
        uint32_t begin = end;
        bool fits;
        if (o.state[f] != UNSEEN) {
            continue;
        }
        status = walk(&o, f, &end, &fits, err);
        if (status == HE_OK && !fits && !force) {
            status = refuse(m, err);
        }
        if (status == HE_OK) {
            if (!fits) {
                settle_clashing(&o, begin, end);
            }
            settle(&o, begin, end);
        }
    }
    if (status == HE_OK) {
        status = turn_all(m, o.state, err);
    }
out:
    he_mem_free(o.mate);
    he_mem_free(o.face_of);
    he_mem_free(o.queue);
    he_mem_free(o.state);
    return status;
}
