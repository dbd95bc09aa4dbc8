/* repair.h - repairs, applied on request, that make a polygon soup representable as a half-edge
 * mesh.
 *
 *     reader -> he_soup -> he_repair_soup -> he_build -> he_repair_mesh -> mesh
 *
 * Repairs are applied in this order, whatever the order of the request.
 *
 * weld: vertices at most `tolerance` apart are merged. In the order of their numbers, each vertex
 * is merged into the first earlier vertex that was kept and is near enough; if there is none, it is
 * kept itself. So no vertex moves farther than the tolerance, kept vertices are farther apart than
 * that, and a chain of vertices with small gaps does not become one vertex. With tolerance 0 only
 * equal positions are merged (-0 equals 0). An attribute of vertices whose values differ between
 * merged vertices becomes an attribute of corners, so that seams of texture and sharp edges stay
 * (build/keep.h).
 *
 * drop_degenerate: of a face that passes a vertex twice only the parts with area are kept. Corners
 * in a row at one vertex become one (1 2 3 3 is the triangle 1 2 3), and a spike, there and back,
 * is removed. Loops that touch in a vertex become separate faces, and a face with a hole is cut
 * into triangles. Faces that have fewer than three corners, or are left with fewer, are dropped.
 *
 * drop_duplicates: of faces with the same corners, begun anywhere and wound either way, the first
 * is kept.
 *
 * orient: faces are reversed until any two that share an edge run along it in opposite directions;
 * faces count as connected only across edges of exactly two faces. The faces of a component are
 * then of two orientations, and those of one are reversed: the fewer faces, or, if there are
 * equally many, those that do not agree with the component's first face. If a component cannot be
 * oriented (a Moebius band) the soup is refused, unless `split` is requested, too. In that case the
 * component is oriented consistently along a spanning tree of its faces, or left as it is if that
 * would not reduce the number of clashes, and is cut apart at edges along which two faces run in
 * one direction. The attribute "normal" of reversed faces, and of their corners, is reversed too.
 *
 * split: every fan of faces gets a vertex of its own. The fan of the first corner keeps the vertex,
 * each other fan gets a copy of it; the copies are numbered after all vertices, in the order of the
 * first corners of the fans. Faces are in one fan if they run along an edge in opposite directions.
 * If more than two faces share an edge, they are paired in order, each with the first unpaired face
 * that runs along it the other way (so two solids that touch are separated); faces without a
 * partner are cut off. If two pairs along an edge would join the same two fans, there would be two
 * edges between the same vertices; so these pairs exchange partners, which divides each of the fans
 * into two. So a closed, consistently oriented surface stays closed. After Gueziec, Taubin, Lazarus
 * and Horn, "Cutting and stitching: converting sets of polygons to manifold surfaces" (2001).
 *
 * fill: holes of at most `hole_edges` edges are closed by one polygon each. Holes that pass a
 * vertex twice, and the rim of a single face, are left open.
 *
 * Vertices and faces keep their order. Other attributes follow their elements: a merged element has
 * the values of the one that is kept, a copy those of its parent, and values of corners follow the
 * corners. Every repair takes time linear in the size of the soup, and memory of a few numbers for
 * each corner. */
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

/* The results of a repair list at most this many elements: the first ones. */
enum { HE_REPAIR_NAMED = 100 };

typedef struct he_repair_pair {
    uint32_t a, b;
} he_repair_pair;

/* The results of one repair. Deleted elements are named by their number in the input, others by
 * their id in the mesh. */
typedef struct he_repair_account {
    /* What the repair changed. weld: number of vertices merged; drop_*: faces dropped; orient:
     * faces reversed; split: vertices made; fill: faces made. */
    uint64_t count;
    /* A second number of what the repair changed. drop_degenerate: faces that lost corners or were
     * cut; orient: components with reversed faces; split: vertices that had several fans. */
    uint64_t parts;
    uint64_t moved; /* weld: number of vertex values that differed and were moved to corners */
    /* What the repair could not do. orient: components that cannot be oriented; fill: holes left
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
    /* The number that each vertex, and each face, of the repaired soup had in the input; NULL if
     * all kept their numbers. */
    uint32_t *vertex_from, *face_from;
    size_t vertices, faces; /* lengths of the two arrays */
    he_repair_account accounts[HE_REPAIR_COUNT];
    /* The first HE_REPAIR_NAMED places at which orient found that a component cannot be oriented;
     * accounts[HE_REPAIR_ORIENT].left is the number of all such components. */
    he_repair_clash clashes[HE_REPAIR_NAMED];
} he_repaired;

void he_repaired_clear(he_repaired *repaired);
/* Returns true if a repair changed the soup that he_build reads. */
bool he_repaired_soup(const he_repaired *repaired);
/* Renames the elements of a report about the repaired soup to their names in the input. */
void he_repaired_report(const he_repaired *repaired, he_report *report);

/* Applies to the soup those repairs of the plan that work on soups. If degenerate faces remain, or
 * a corner names a vertex that does not exist, the repairs that require valid faces are not begun,
 * and he_build will refuse the soup.
 *
 * The soup stays the caller's; `out` must be {0} before, and the caller clears it in any case.
 * After HE_NOT_ORIENTABLE the vertices and faces are as the repairs before orient left them and no
 * face is reversed, so that the caller can ask he_repair_advise; attribute columns still have the
 * values in the order of the input, which may not match the elements. After another failure the
 * caller can only clear the soup.
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

/* Returns a set of repairs, among them all of `asked`, that would make he_build accept a soup which
 * it refused after the repairs `asked`, or which he_repair_soup found not orientable. Returns 0 if
 * no set would, because a corner names a vertex that does not exist. Ignores columns. The faces of
 * the soup may change; the caller can then only clear it.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_repair_advise(he_soup *soup, unsigned asked, unsigned *out,
                                        he_error *err);

#endif
