/* drop.c - the repair drop_duplicates: of several faces with equal vertices keeps only the
 * first. */
#include "build/soup_check.h"
#include "repair/mend.h"

static he_status no_memory(const he_soup *soup, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory to compare %zu faces", soup->face_count);
}

/* Removes the faces whose bit is set in `gone`, and closes the gaps in the arrays of faces and
 * corners. */
static he_status drop(he_mend *m, const uint64_t *gone, he_error *err)
{
    he_soup *soup = m->soup;
    he_repaired *out = m->out;
    he_status status = he_mend_corners(m, err);
    if (status == HE_OK && out->face_from == NULL) {
        out->face_from = he_mend_same(soup->face_count, soup->face_count);
        if (out->face_from == NULL) {
            status = no_memory(soup, err);
        }
    }
    if (status != HE_OK) {
        return status;
    }
    uint32_t faces = 0, corners = 0;
    for (uint32_t f = 0; f < soup->face_count; f++) {
        uint32_t begin = soup->starts[f], end = he_soup_end(soup, f);
        if (he_bits_get(gone, f)) {
            continue;
        }
        /* The remaining faces move towards the beginning of the array. No entry is overwritten
         * before it is read, because faces <= f and corners <= begin. */
        soup->starts[faces] = corners;
        out->face_from[faces++] = out->face_from[f];
        for (uint32_t c = begin; c < end; c++, corners++) {
            soup->corners[corners] = soup->corners[c];
            if (m->corner_from != NULL) {
                m->corner_from[corners] = m->corner_from[c];
            }
        }
    }
    soup->face_count = out->faces = faces;
    soup->corner_count = corners;
    return HE_OK;
}

/* The order in which the corners of a face are read to compare faces: from the corner with the
 * lowest vertex towards that of its two neighbours which has the lower vertex. Faces with equal
 * loops are read in equal orders, even if one of the faces is reversed. */
typedef struct way {
    const uint32_t *corners;
    uint32_t count, first;
    bool back;
} way;

static way way_of(const he_soup *soup, uint32_t f)
{
    way w = {.corners = soup->corners + soup->starts[f],
             .count = he_soup_end(soup, f) - soup->starts[f]};
    for (uint32_t i = 1; i < w.count; i++) {
        if (w.corners[i] < w.corners[w.first]) {
            w.first = i;
        }
    }
    uint32_t after = w.corners[w.first + 1 < w.count ? w.first + 1 : 0];
    uint32_t before = w.corners[w.first > 0 ? w.first - 1 : w.count - 1];
    w.back = before < after;
    return w;
}

static uint32_t along(const way *w, uint32_t i)
{
    uint32_t k = w->back ? w->first + w->count - i : w->first + i;
    return w->corners[k < w->count ? k : k - w->count];
}

static uint32_t hash_of(const way *w, uint64_t h)
{
    for (uint32_t i = 0; i < w->count; i++) {
        h = (h ^ along(w, i)) * 0x9E3779B97F4A7C15;
        h ^= h >> 29;
    }
    return (uint32_t)(h * 0xBF58476D1CE4E5B9 >> 32);
}

static bool same(const way *a, const way *b)
{
    if (a->count != b->count) {
        return false;
    }
    for (uint32_t i = 0; i < a->count; i++) {
        if (along(a, i) != along(b, i)) {
            return false;
        }
    }
    return true;
}

typedef struct slot {
    /* `hash`: the hash of a face's vertices; `face`: number of the face, plus 1. In a free slot
     * `hash` and `face` are 0. */
    uint32_t hash, face;
} slot;

/* Returns the earlier face that has the vertices of face f. If there is none, adds f to the table
 * and returns HE_NONE. */
static uint32_t find(const he_soup *soup, slot *slots, size_t mask, uint32_t f)
{
    way w = way_of(soup, f);
    uint32_t h = hash_of(&w, (uint64_t)(uintptr_t)slots * 0x94D049BB133111EB);
    size_t at = h & mask;
    for (; slots[at].face != 0; at = (at + 1) & mask) {
        if (slots[at].hash == h) {
            way other = way_of(soup, slots[at].face - 1);
            if (same(&w, &other)) {
                return slots[at].face - 1;
            }
        }
    }
    slots[at] = (slot){h, f + 1};
    return HE_NONE;
}

he_status he_mend_drop_duplicates(he_mend *m, he_error *err)
{
    he_soup *soup = m->soup;
    he_repair_account *account = &m->out->accounts[HE_REPAIR_DROP_DUPLICATES];
    size_t count = 16;
    while (count < 2 * soup->face_count) {
        count *= 2;
    }
    slot *slots = he_mem_zero(count, sizeof *slots);
    uint64_t *gone = he_bits_new(soup->face_count);
    uint32_t *now = he_mem_array(NULL, soup->face_count, sizeof *now), kept = 0;
    he_status status = HE_OK;
    if (slots == NULL || gone == NULL || now == NULL) {
        status = no_memory(soup, err);
    }
    for (uint32_t f = 0; f < soup->face_count && status == HE_OK; f++) {
        status = he_progress_at(soup->limits.progress, f, soup->face_count, err);
        uint32_t earlier = find(soup, slots, count - 1, f);
        if (earlier == HE_NONE) {
            now[f] = kept++;
            continue;
        }
        he_bits_set(gone, f);
        account->count++;
        he_mend_name(account, he_mend_input(m->out->face_from, f), now[earlier]);
    }
    if (status == HE_OK && account->count > 0) {
        status = drop(m, gone, err);
    }
    he_mem_free(slots);
    he_mem_free(gone);
    he_mem_free(now);
    return status;
}
