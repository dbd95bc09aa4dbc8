#include "model/calls_segment.h"

#include "mesh/column.h"
#include "mesh/marks.h"
#include "model/rows.h"

#include <stdio.h>
#include <string.h>

static const char *const names[] = {"patch", "part", "selected"};

bool md_segment_draw(md_draft *d)
{
    if (md_chance(d->r, 60)) {
        md_give_number(d, "angle", 3.1 * md_unit(d->r));
    } else {
        md_give_number(d, "planes", md_from(d->r, 1, md_chance(d->r, 20) ? 200 : 8));
    }
    if (md_chance(d->r, 60)) {
        md_give_choice(d, "features", md_chance(d->r, 50) ? "replace" : "ignore");
    }
    if (md_chance(d->r, 3)) {
        md_give_text(d, "into", "position");
    } else if (md_chance(d->r, 30)) {
        /* A name that no set has as a bool; `append` refuses two types of one name. */
        md_give_text(d, "into", md_chance(d->r, 95) ? "patch" : names[md_below(d->r, 3)]);
    }
    return true;
}

static const char *name_of(const md_call *c)
{
    return md_get(c, "into")->given ? md_get(c, "into")->text : "patch";
}

static bool keeps(const md_call *c)
{
    return md_get(c, "features")->choice == 0;
}

static bool ignores(const md_call *c)
{
    return md_get(c, "features")->choice == 2;
}

uint64_t md_segment_refusals(const md_call *c, const he_mesh *m)
{
    if (strcmp(name_of(c), "position") == 0) {
        return OR_BIT(HE_BAD_VALUE);
    }
    const he_column *patch = he_mesh_find_column(m, HE_FACE, name_of(c));
    const he_column *feature = he_mesh_find_column(m, HE_EDGE, "feature");
    const bool whole = patch == NULL || (patch->components == 1 && patch->labels == NULL &&
                                         (patch->type == HE_INT32 || patch->type == HE_UINT32));
    const bool marks = ignores(c) || feature == NULL || he_is_mark(feature, "feature");
    return whole && marks ? 0 : OR_BIT(HE_ATTRIBUTE_CLASH);
}

/* --- checking the patches --- */

static uint32_t patch_of(const he_column *column, uint32_t f)
{
    uint32_t number;
    memcpy(&number, he_column_value(column, f), sizeof number);
    return number;
}

static uint32_t root_of(const uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        i = parent[i];
    }
    return i;
}

static bool is_wrong(char text[OR_TEXT], const char *what, uint32_t id)
{
    (void)snprintf(text, OR_TEXT, "%s: %u", what, id);
    return false;
}

/* Returns whether a patch may cross the edge: for patches by planes, whether no mark forbids it. */
static or_verdict crosses(const md_call *c, const or_mesh *o, uint32_t e)
{
    if (keeps(c) && o->edge[e].feature) {
        return OR_NO;
    }
    const bool inner = o->left[o->edge[e].a][o->edge[e].b] != OR_NONE &&
                       o->left[o->edge[e].b][o->edge[e].a] != OR_NONE;
    return md_get(c, "planes")->given ? (inner ? OR_EITHER : OR_NO)
                                      : or_is_smooth(o, e, md_get(c, "angle")->number);
}

/* Requires that patches are numbered from 1 in the order of their lowest faces, and finds their
 * number. */
static bool check_numbers(const or_mesh *o, const he_column *column, uint32_t *patches,
                          char text[OR_TEXT])
{
    *patches = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        const uint32_t patch = patch_of(column, f);
        if (!o->face[f].alive) {
            continue;
        }
        if (patch < 1 || patch > *patches + 1) {
            return is_wrong(text, "a patch has a wrong number at face", f);
        }
        *patches += patch > *patches;
    }
    return true;
}

/* Requires that faces are in one patch if they must be, and that a chain of edges that a patch may
 * cross joins all faces of each patch. */
static bool check_chains(const md_call *c, const or_mesh *o, const he_column *column,
                         char text[OR_TEXT])
{
    static uint32_t parent[OR_FACES], first[OR_FACES + 1];
    memset(first, 0xFF, sizeof first);
    for (uint32_t f = 0; f < o->faces; f++) {
        parent[f] = f;
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        const or_verdict verdict = o->edge[e].alive ? crosses(c, o, e) : OR_NO;
        if (verdict == OR_NO) {
            continue;
        }
        const uint32_t f = o->left[o->edge[e].a][o->edge[e].b];
        const uint32_t g = o->left[o->edge[e].b][o->edge[e].a];
        const bool same = patch_of(column, f) == patch_of(column, g);
        if (verdict == OR_YES && !same) {
            return is_wrong(text, "patches end at a smooth edge", e);
        }
        if (same) {
            parent[root_of(parent, f)] = root_of(parent, g);
        }
    }
    for (uint32_t f = 0; f < o->faces; f++) {
        if (!o->face[f].alive) {
            continue;
        }
        uint32_t *one = &first[patch_of(column, f)];
        *one = *one == OR_NONE ? f : *one;
        if (root_of(parent, f) != root_of(parent, *one)) {
            return is_wrong(text, "a patch is not connected at face", f);
        }
    }
    return true;
}

static bool check_marks(const md_call *c, const or_mesh *o, const he_mesh *after,
                        const he_column *column, char text[OR_TEXT])
{
    const he_column *mark = he_mark_find(after, HE_EDGE, "feature");
    for (uint32_t e = 0; e < o->edges; e++) {
        const uint32_t f = o->left[o->edge[e].a][o->edge[e].b];
        const uint32_t g = o->left[o->edge[e].b][o->edge[e].a];
        if (!o->edge[e].alive) {
            continue;
        }
        const bool inner = f != OR_NONE && g != OR_NONE;
        or_verdict wanted =
            inner && md_get(c, "planes")->given && patch_of(column, f) != patch_of(column, g)
                ? OR_YES
                : OR_NO;
        if (inner && md_get(c, "angle")->given) {
            wanted = (or_verdict)(OR_YES - or_is_smooth(o, e, md_get(c, "angle")->number));
        }
        if (ignores(c) || (keeps(c) && o->edge[e].feature)) {
            wanted = o->edge[e].feature ? OR_YES : OR_NO;
        }
        if (wanted != OR_EITHER && he_is_marked(mark, e) != (wanted == OR_YES)) {
            return is_wrong(text, "a mark is wrong at edge", e);
        }
    }
    return true;
}

/* Returns the number of components into which the mesh falls at the marks that are kept. */
static uint32_t count_components(const md_call *c, const or_mesh *o)
{
    static uint32_t parent[OR_FACES];
    uint32_t count = 0;
    for (uint32_t f = 0; f < o->faces; f++) {
        parent[f] = f;
        count += o->face[f].alive;
    }
    for (uint32_t e = 0; e < o->edges; e++) {
        const uint32_t f = o->left[o->edge[e].a][o->edge[e].b];
        const uint32_t g = o->left[o->edge[e].b][o->edge[e].a];
        if (o->edge[e].alive && f != OR_NONE && g != OR_NONE && !(keeps(c) && o->edge[e].feature) &&
            root_of(parent, f) != root_of(parent, g)) {
            parent[root_of(parent, f)] = root_of(parent, g);
            count--;
        }
    }
    return count;
}

static bool check_count(const md_call *c, const or_mesh *o, uint32_t patches, char text[OR_TEXT])
{
    if (!md_get(c, "planes")->given) {
        return true;
    }
    const uint32_t components = count_components(c, o);
    const double planes = md_get(c, "planes")->number;
    return (patches >= components && (patches <= planes || patches == components)) ||
           is_wrong(text, "the number of patches is wrong", patches);
}

bool md_segment_is_right(const md_call *c, const or_mesh *o, const he_mesh *after,
                         char text[OR_TEXT])
{
    const he_column *column = he_mesh_find_column(after, HE_FACE, name_of(c));
    uint32_t patches = 0;
    if (column == NULL) {
        return is_wrong(text, "there is no attribute of patches", 0);
    }
    return check_numbers(o, column, &patches, text) && check_chains(c, o, column, text) &&
           check_marks(c, o, after, column, text) && check_count(c, o, patches, text);
}

/* --- in the model test --- */

static uint64_t play_segment(const md_call *c, or_mesh *o, const he_mesh *m)
{
    (void)o;
    return md_segment_refusals(c, m);
}

const md_row md_segment_rows[] = {
    {"segment", 0, md_segment_draw, play_segment, NULL, true},
    {.name = NULL},
};
