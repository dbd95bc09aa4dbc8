/* repair.h - what makes a polygon soup one that the structure can hold, on request.
 *
 *     reader -> he_soup -> he_repair_soup -> he_build -> he_repair_mesh -> mesh
 *
 * Repairs are applied in this order, whatever the order in which they are asked for.
 *
 * weld: vertices at most `tolerance` apart become one. In the order of their numbers, each joins
 * the first of those kept so far that is near enough, or is kept. So none moves further than the
 * tolerance, kept ones are further apart than that, and chains do not creep. With tolerance 0 only
 * equal positions meet (-0 is 0). An attribute of vertices that differs between some that become
 * one becomes an attribute of corners, so that seams of texture and sharp edges stay
 * (build/keep.h).
 *
 * drop_degenerate: a face that comes to a vertex twice keeps what has an area. Of corners at one
 * vertex in a row one stays (1 2 3 3 is the triangle 1 2 3), and a spike, there and back, goes.
 * Loops that touch in a vertex become faces of their own, and a face with a hole is cut into
 * triangles. What has less than three corners, before or after that, is left out.
 *
 * drop_duplicates: of faces with the same corners, begun anywhere and wound either way, the first
 * is kept.
 *
 * orient: faces are turned until all that share an edge run along it in opposite directions, as far
 * as edges of two faces lead. The larger part of a component keeps its direction; the part of its
 * first face, where they are equal. Where a component cannot be oriented (a Moebius band) the soup
 * is refused, unless it is to be split as well: then it is wound consistently along a tree of its
 * faces, or left where that makes no fewer of them clash, and cut where they do. The attribute
 * "normal" of the faces that are turned, and of their corners, is turned with them.
 *
 * split: every fan of faces gets its vertex for itself. The fan of the first corner keeps it, the
 * others get copies, numbered after all vertices in the order of their first corners. Faces hang
 * together in a fan where they run along an edge in opposite directions. Where more than two have
 * an edge, they are paired in their order, each with the first that waits and runs the other way
 * (two solids that touch come apart); the rest is cut off. Where two pairs along an edge lie
 * between the same two fans, the edge would be doubled: they exchange partners, which makes two
 * fans of each. So what is closed, and wound consistently, stays closed. After Gueziec, Taubin,
 * Lazarus and Horn, "Cutting and stitching: converting sets of polygons to manifold surfaces"
 * (2001).
 *
 * fill: holes of at most `hole_edges` edges are closed by one polygon each. Those that pass a
 * vertex twice, and the rim of a single face, are left.
 *
 * Vertices and faces keep their order. Other attributes go with their elements: those of the vertex
 * or face that is kept, its parent's with a copy, those of corners with the corners. Every repair
 * takes time linear in the soup, and a few numbers of memory for each corner. */
#ifndef HE_REPAIR_REPAIR_H
#define HE_REPAIR_REPAIR_H

#include "build/build.h"

typedef enum he_repair {
    HE_REPAIR_WELD,
    HE_REPAIR_DROP_DEGENERATE,
    HE_REPAIR_DROP_DUPLICATES,
    HE_REPAIR_ORIENT,
    HE_REPAIR_SPLIT,
    HE_REPAIR_FILL,
    HE_REPAIR_COUNT
} he_repair;

/* Their names in this order, ends in NULL. */
extern const char *const he_repair_names[];

/* A set of repairs has these bits. */
static inline unsigned he_repair_bit(he_repair repair)
{
    return 1u << repair;
}

typedef struct he_repair_plan {
    unsigned which;    /* a set; 0: none */
    double tolerance;  /* of weld: finite, not negative */
    size_t hole_edges; /* of fill */
} he_repair_plan;

/* The first elements of each repair that are named. */
enum { HE_REPAIR_NAMED = 100 };

typedef struct he_repair_pair {
    uint32_t a, b;
} he_repair_pair;

/* What one repair did. What is gone is named by its number in the input, what is there by its id in
 * the mesh. */
typedef struct he_repair_account {
    uint64_t count; /* weld: vertices gone; drop_*: faces gone; orient: faces turned; split:
                       vertices made; fill: faces made */
    uint64_t parts; /* drop_degenerate: faces that lost corners or were cut up; orient: components
                       with turned faces; split: vertices that had several fans */
    uint64_t moved; /* weld: values of vertices that went to corners, being different */
    uint64_t left;  /* orient: components that cannot be oriented; fill: holes left open */
    /* weld: gone, the one it joined; drop_degenerate: the face, what became of it, 0 or more faces;
     * drop_duplicates: gone, the one kept; orient: turned face, HE_NONE; split: made, its parent;
     * fill: face, its corners */
    he_repair_pair pairs[HE_REPAIR_NAMED];
    size_t named;
} he_repair_account;

/* A face of a component that cannot be oriented, and its edge where that is seen. */
typedef struct he_repair_clash {
    uint32_t face, vertex, other;
} he_repair_clash;

typedef struct he_repaired {
    /* Numbers in the input, by number in the soup; NULL where all kept theirs. */
    uint32_t *vertex_from, *face_from;
    size_t vertices, faces; /* entries of these */
    he_repair_account accounts[HE_REPAIR_COUNT];
    he_repair_clash clashes[HE_REPAIR_NAMED]; /* of orient, accounts[HE_REPAIR_ORIENT].left */
} he_repaired;

void he_repaired_clear(he_repaired *repaired);
/* Did anything change that he_build reads? */
bool he_repaired_soup(const he_repaired *repaired);
/* Name the elements of a report about the repaired soup as the input does. */
void he_repaired_report(const he_repaired *repaired, he_report *report);

/* Apply what is planned for a soup. Where faces that would have to be dropped remain, and where a
 * corner names no vertex, the repairs that could not deal with them are not begun: he_build refuses
 * the soup. HE_NOT_ORIENTABLE with the face, numbered as in the input; HE_LIMIT when copies exceed
 * the soup's limits; HE_NO_MEMORY; HE_CANCELLED.
 *
 * The soup stays the caller's, `out` is {0} before and the caller's to clear, in any case. After
 * HE_NOT_ORIENTABLE the vertices and faces are as the repairs before orient left them and no face
 * is turned, so that he_repair_advise can be asked; columns have the rows of the input still, which
 * need not be those of the elements. After another failure the soup is only to be cleared. */
HE_NODISCARD he_status he_repair_soup(he_soup *soup, const he_repair_plan *plan, he_repaired *out,
                                      he_error *err);
/* The same for the mesh it became: fill. Nothing may record. HE_IDS_EXHAUSTED, HE_NO_MEMORY,
 * HE_CANCELLED. */
HE_NODISCARD he_status he_repair_mesh(he_mesh *mesh, const he_repair_plan *plan, he_repaired *out,
                                      he_error *err);

/* he_build refused the soup to which the set `asked` was applied, or he_repair_soup found it not to
 * be orientable: which set, `asked` included, would let it pass? 0 where none would: a corner names
 * no vertex. Columns are not looked at. The soup may get other faces, and is only to be cleared
 * after.
 * HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_repair_advise(he_soup *soup, unsigned asked, unsigned *out,
                                        he_error *err);

#endif
