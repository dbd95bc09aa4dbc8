/* repair.h - repairs that make a polygon soup representable as a half-edge mesh, on request.
 *
 *     reader -> he_soup -> he_repair_soup -> he_build -> he_repair_mesh -> mesh
 *
 * Repairs are applied in this order, whatever the order of the request.
 *
 * weld: vertices at most `tolerance` apart are merged. In the order of their numbers, each vertex
 * is merged into the first vertex kept so far that is near enough, or is kept itself. So no vertex
 * moves farther than the tolerance, kept vertices are farther apart than that, and merging does not
 * run along chains. With tolerance 0 only equal positions are merged (-0 equals 0). An attribute of
 * vertices whose values differ between merged vertices becomes an attribute of corners, so that
 * seams of texture and sharp edges stay (build/keep.h).
 *
 * drop_degenerate: a face that passes a vertex twice keeps the parts that have area. Corners in a
 * row at one vertex become one (1 2 3 3 is the triangle 1 2 3), and a spike, there and back, is
 * removed. Loops that touch in a vertex become separate faces, and a face with a hole is cut into
 * triangles. Faces with fewer than three corners, before or after that, are dropped.
 *
 * drop_duplicates: of faces with the same corners, begun anywhere and wound either way, the first
 * is kept.
 *
 * orient: faces are reversed until any two that share an edge run along it in opposite directions;
 * only edges of two faces connect. The faces of a component are in two parts, of which one is
 * reversed: the smaller part, or, if both are equal, the part without the component's first face.
 * If a component cannot be oriented (a Moebius band) the soup is refused, unless it is split as
 * well: then it is oriented consistently along a tree of its faces, or left if that would not
 * reduce the clashes, and cut where faces clash. The attribute "normal" of reversed faces, and of
 * their corners, is reversed too.
 *
 * split: every fan of faces gets a vertex of its own. The fan of the first corner keeps the vertex,
 * the others get copies, numbered after all vertices in the order of their first corners. Faces are
 * in one fan if they run along an edge in opposite directions. If more than two faces have an edge,
 * they are paired in order, each with the first unpaired one that runs the other way (two solids
 * that touch are separated); the rest is cut off. If two pairs along an edge are between the same
 * two fans, the edge would be doubled: they exchange partners, which makes two fans of each. So a
 * closed, consistently oriented surface stays closed. After Gueziec, Taubin, Lazarus and Horn,
 * "Cutting and stitching: converting sets of polygons to manifold surfaces" (2001).
 *
 * fill: holes of at most `hole_edges` edges are closed by one polygon each. Holes that pass a
 * vertex twice, and the rim of a single face, are left open.
 *
 * Vertices and faces keep their order. Other attributes follow their elements: a merged element has
 * the values of the one that is kept, a copy those of its parent, and values of corners follow the
 * corners. Every repair takes time linear in the soup, and a few numbers of memory for each
 * corner. */
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

/* The names of the repairs, in the order in which they are applied; ends in NULL. */
extern const char *const he_repair_names[];

/* Returns the bit that stands for a repair in a set of repairs. */
static inline unsigned he_repair_bit(he_repair repair)
{
    return 1u << repair;
}

typedef struct he_repair_plan {
    unsigned which; /* a set of bits (he_repair_bit) of the repairs to apply; 0: none */
    /* The largest distance between vertices that weld merges; finite, not negative. */
    double tolerance;
    size_t hole_edges; /* the most edges of a hole that fill closes */
} he_repair_plan;

/* The most elements, the first ones, that the account of a repair lists. */
enum { HE_REPAIR_NAMED = 100 };

typedef struct he_repair_pair {
    uint32_t a, b;
} he_repair_pair;

/* The results of one repair. Deleted elements are named by their number in the input, others by
 * their id in the mesh. */
typedef struct he_repair_account {
    /* The number of things a repair did. weld: vertices merged; drop_*: faces dropped; orient:
     * faces reversed; split: vertices made; fill: faces made. */
    uint64_t count;
    /* A second number. drop_degenerate: faces that lost corners or were cut; orient: components
     * with reversed faces; split: vertices that had several fans. */
    uint64_t parts;
    uint64_t moved; /* weld: number of vertex values that differed and were moved to corners */
    /* The number of things left: components that orient could not orient, holes that fill left
     * open. */
    uint64_t left;
    /* The elements concerned, as pairs. weld: the merged vertex, the one it was merged into;
     * drop_degenerate: the face, and how many faces were made of it; drop_duplicates: the dropped
     * face, the one kept; orient: the reversed face, HE_NONE; split: the new vertex, its parent;
     * fill: the face, and how many corners it has. */
    he_repair_pair pairs[HE_REPAIR_NAMED];
    size_t named;
} he_repair_account;

/* A face of a component that cannot be oriented, and the edge, from `vertex` to `other`, along
 * which this face and a neighbour run in one direction. */
typedef struct he_repair_clash {
    uint32_t face, vertex, other;
} he_repair_clash;

typedef struct he_repaired {
    /* The number that each vertex (face) of the repaired soup had in the input; NULL if all kept
     * their numbers. */
    uint32_t *vertex_from, *face_from;
    size_t vertices, faces; /* lengths of the two arrays */
    he_repair_account accounts[HE_REPAIR_COUNT];
    /* The first HE_REPAIR_NAMED places at which orient found that a component cannot be oriented;
     * accounts[HE_REPAIR_ORIENT].left is the number of all. */
    he_repair_clash clashes[HE_REPAIR_NAMED];
} he_repaired;

void he_repaired_clear(he_repaired *repaired);
/* Returns true if a repair changed the soup that he_build reads. */
bool he_repaired_soup(const he_repaired *repaired);
/* Renames the elements of a report about the repaired soup to their names in the input. */
void he_repaired_report(const he_repaired *repaired, he_report *report);

/* Applies to the soup those repairs of the plan that work on soups. If degenerate faces remain, or
 * a corner names a vertex that does not exist, the repairs that could not handle them are not
 * begun, and he_build will refuse the soup.
 *
 * The soup stays the caller's; `out` must be {0} before, and the caller clears it in any case.
 * After HE_NOT_ORIENTABLE the vertices and faces are as the repairs before orient left them and no
 * face is reversed, so that the caller can ask he_repair_advise; columns still have the rows of the
 * input, which may not match the elements. After another failure the caller can only clear the
 * soup.
 * Returns HE_NOT_ORIENTABLE, naming a face by its number in the input, if a component cannot be
 * oriented.
 * Returns HE_LIMIT if copies exceed the soup's limits.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_repair_soup(he_soup *soup, const he_repair_plan *plan, he_repaired *out,
                                      he_error *err);
/* Applies to the mesh that was built those repairs of the plan that work on meshes: fill. The mesh
 * must not be recording.
 * Returns HE_IDS_EXHAUSTED if no ids are left.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_repair_mesh(he_mesh *mesh, const he_repair_plan *plan, he_repaired *out,
                                      he_error *err);

/* Finds which set of repairs, `asked` included, would make he_build accept a soup that it refused
 * after the repairs `asked`, or that he_repair_soup found not orientable; 0 if none would, because
 * a corner names a vertex that does not exist. Ignores columns. The faces of the soup may change;
 * the caller can then only clear it.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_repair_advise(he_soup *soup, unsigned asked, unsigned *out,
                                        he_error *err);

#endif
