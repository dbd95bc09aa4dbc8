#include "query/topology.h"

#include "base/forest.h"
#include "mesh/walk.h"

static uint32_t halfedge_end(const he_mesh *m)
{
    return 2u * m->c.edges.issued;
}

static he_status no_memory(he_error *err)
{
    he_fail_plain(err, HE_NO_MEMORY, "no memory to find the topology of the mesh");
    return HE_NO_MEMORY;
}

static he_status broken(he_kind kind, uint32_t id, he_error *err)
{
    return he_fail(err, HE_CORRUPT, kind, id, "the links at %s %u are damaged", he_kind_name(kind),
                   id);
}

/* --- components: union-find in one array --- */

/* Makes a union-find forest whose trees are the connected components. For HE_VERTEX its elements
 * are the vertices, joined by edges; for HE_FACE its elements are the faces, joined where they
 * share an edge. *joins is set to the number of times that two trees were joined. */
static he_status join_all(const he_mesh *m, he_kind kind, uint32_t **out, uint32_t *joins,
                          he_error *err)
{
    uint32_t issued = he_mesh_issued(m, kind);
    const uint32_t *side = kind == HE_VERTEX ? m->c.origin : m->c.face;
    uint32_t *parent = he_mem_array(NULL, issued, sizeof *parent);
    if (parent == NULL) {
        return no_memory(err);
    }
    for (uint32_t i = 0; i < issued; i++) {
        parent[i] = i;
    }
    uint32_t count = 0;
    for (uint32_t e = 0; e < m->c.edges.issued; e++) {
        he_status status = he_progress_at(m->progress, e, m->c.edges.issued, err);
        if (status != HE_OK) {
            he_mem_free(parent);
            return status;
        }
        if (!he_edge_is_live(m, (he_edge){e})) {
            continue;
        }
        uint32_t a = side[2u * e], b = side[2u * e + 1u];
        if (a < issued && b < issued) {
            count += he_forest_unite(parent, a, b);
        } else if (kind == HE_VERTEX || (a >= issued && a != HE_NONE) ||
                   (b >= issued && b != HE_NONE)) {
            he_mem_free(parent);
            return broken(HE_EDGE, e, err);
        }
    }
    *out = parent;
    *joins = count;
    return HE_OK;
}

static he_status count_components(const he_mesh *m, he_kind kind, uint32_t elements, uint32_t *out,
                                  he_error *err)
{
    uint32_t *parent = NULL, joins = 0;
    he_status status = join_all(m, kind, &parent, &joins, err);
    if (status == HE_OK) {
        he_mem_free(parent);
        *out = elements - joins;
    }
    return status;
}

static he_status add_component(he_components *list, he_component component, he_error *err)
{
    if (list->count == list->capacity) {
        size_t capacity = he_mem_grown(list->capacity, list->count + 1);
        he_component *grown = he_mem_array(list->components, capacity, sizeof *grown);
        if (grown == NULL) {
            return no_memory(err);
        }
        list->components = grown;
        list->capacity = capacity;
    }
    list->components[list->count++] = component;
    return HE_OK;
}

/* Returns the root of the union-find tree to which face f belongs. */
static uint32_t tree_of(const he_mesh *m, he_connection by, uint32_t *parent, uint32_t f)
{
    return he_forest_root(parent, by == HE_JOINED_BY_EDGE ? f : m->c.origin[m->c.face_halfedge[f]]);
}

/* Numbers the components, which are the trees of the union-find forest, in the order of their
 * lowest face ids, and counts the faces of each. label[r] of the root r of a tree is set to the
 * number of the component. */
static he_status count_faces(const he_mesh *m, he_connection by, uint32_t *parent, uint32_t *label,
                             he_components *list, he_error *err)
{
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (!he_face_is_live(m, (he_face){f})) {
            continue;
        }
        uint32_t h = m->c.face_halfedge[f];
        if (h >= halfedge_end(m) || m->c.origin[h] >= m->c.vertices.issued) {
            return broken(HE_FACE, f, err);
        }
        uint32_t tree = tree_of(m, by, parent, f);
        if (label[tree] == HE_NONE) {
            label[tree] = (uint32_t)list->count;
            he_status status = add_component(list, (he_component){0, 0, f}, err);
            if (status != HE_OK) {
                return status;
            }
        }
        list->components[label[tree]].faces++;
    }
    return HE_OK;
}

/* Counts the vertices of each component: those at which the component has a face. If faces that
 * share a vertex are joined, all faces at a vertex are in one component; otherwise each fan of
 * faces at a vertex may be in a different component. last[c] is the vertex that was last counted
 * for component c, so that a vertex at which the component has two fans is counted once. */
static he_status count_vertices(const he_mesh *m, he_connection by, uint32_t *parent,
                                const uint32_t *label, uint32_t *last, he_components *list,
                                he_error *err)
{
    const uint32_t end = halfedge_end(m);
    uint32_t budget = end;
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        uint32_t first = m->c.vertex_halfedge[v], h = first;
        if (first == HE_NONE || first == HE_DEAD) {
            continue;
        }
        if (by == HE_JOINED_BY_VERTEX) {
            uint32_t component = label[he_forest_root(parent, v)];
            if (component >= list->count) {
                return broken(HE_VERTEX, v, err);
            }
            list->components[component].vertices++;
            continue;
        }
        bool boundary = first < end && m->c.face[first] == HE_NONE;
        do {
            if (h >= end || budget-- == 0) {
                return broken(HE_VERTEX, v, err);
            }
            uint32_t f = m->c.face[h];
            if (f < m->c.faces.issued) {
                uint32_t component = label[he_forest_root(parent, f)];
                if (component >= list->count) {
                    return broken(HE_FACE, f, err);
                }
                list->components[component].vertices += last[component] != v;
                last[component] = v;
            } else if (f != HE_NONE) {
                return broken(HE_HALFEDGE, h, err);
            }
            h = m->c.prev[h] ^ 1u;
        } while (boundary && h != first);
    }
    return HE_OK;
}

static uint32_t *none_new(size_t count)
{
    uint32_t *array = he_mem_array(NULL, count, sizeof *array);
    for (size_t i = 0; array != NULL && i < count; i++) {
        array[i] = HE_NONE;
    }
    return array;
}

he_status he_components_find(const he_mesh *m, he_connection by, he_components *out, he_error *err)
{
    he_kind kind = by == HE_JOINED_BY_VERTEX ? HE_VERTEX : HE_FACE;
    uint32_t *parent = NULL, *label = NULL, *last = NULL, joins = 0;
    he_components list = {0};
    he_status status = join_all(m, kind, &parent, &joins, err);
    if (status != HE_OK) {
        goto out;
    }
    label = none_new(he_mesh_issued(m, kind));
    if (label == NULL) {
        status = no_memory(err);
        goto out;
    }
    status = count_faces(m, by, parent, label, &list, err);
    if (status != HE_OK) {
        goto out;
    }
    last = none_new(list.count);
    if (last == NULL) {
        status = no_memory(err);
        goto out;
    }
    status = count_vertices(m, by, parent, label, last, &list, err);
out:
    he_mem_free(parent);
    he_mem_free(label);
    he_mem_free(last);
    if (status != HE_OK) {
        he_components_clear(&list);
        return status;
    }
    *out = list;
    return HE_OK;
}

void he_components_clear(he_components *components)
{
    he_mem_free(components->components);
    *components = (he_components){0};
}

he_status he_components_label(const he_mesh *m, uint32_t **labels, uint32_t *count, he_error *err)
{
    uint32_t *label = NULL, joins = 0, found = 0;
    he_status status = join_all(m, HE_FACE, &label, &joins, err);
    if (status != HE_OK) {
        return status;
    }
    /* label[f] is at first the parent of face f in the union-find forest, and is overwritten by the
     * number of the component of f. The parent of a face has a lower id than the face, so
     * label[parent] is already the number of a component here. */
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        if (!he_face_is_live(m, (he_face){f})) {
            label[f] = HE_NONE;
        } else {
            label[f] = label[f] == f ? found++ : label[label[f]];
        }
    }
    *labels = label;
    *count = found;
    return HE_OK;
}

/* --- boundary loops --- */

static he_status add_loop(he_boundaries *list, he_boundary loop, he_error *err)
{
    if (list->count == list->capacity) {
        size_t capacity = he_mem_grown(list->capacity, list->count + 1);
        he_boundary *grown = he_mem_array(list->loops, capacity, sizeof *grown);
        if (grown == NULL) {
            return no_memory(err);
        }
        list->loops = grown;
        list->capacity = capacity;
    }
    list->loops[list->count++] = loop;
    return HE_OK;
}

/* Follows the boundary loop of half-edge `first` and sets *length to the number of its half-edges.
 * A half-edge that was visited before means that the links are damaged and two loops run into each
 * other. */
static he_status follow_hole(const he_mesh *m, uint32_t first, uint64_t *seen, uint32_t *length,
                             he_error *err)
{
    uint32_t h = first, n = 0;
    do {
        if (h >= halfedge_end(m) || m->c.face[h] != HE_NONE || he_bits_get(seen, h)) {
            return broken(HE_HALFEDGE, first, err);
        }
        he_bits_set(seen, h);
        n++;
        h = m->c.next[h];
    } while (h != first);
    *length = n;
    return HE_OK;
}

he_status he_boundaries_find(const he_mesh *m, he_boundaries *out, he_error *err)
{
    he_boundaries list = {0};
    he_status status = HE_OK;
    uint32_t left = m->c.boundary_halfedges;
    uint64_t *seen = left == 0 ? NULL : he_bits_new(halfedge_end(m));
    if (left > 0 && seen == NULL) {
        return no_memory(err);
    }
    for (uint32_t h = 0; left > 0 && h < halfedge_end(m); h++) {
        if (m->c.face[h] != HE_NONE || he_bits_get(seen, h)) {
            continue;
        }
        uint32_t length = 0;
        status = follow_hole(m, h, seen, &length, err);
        if (status == HE_OK && length > left) {
            status = broken(HE_HALFEDGE, h, err);
        }
        if (status == HE_OK) {
            status = add_loop(&list, (he_boundary){h, length}, err);
        }
        if (status != HE_OK) {
            break;
        }
        left -= length;
    }
    he_mem_free(seen);
    if (status != HE_OK) {
        he_boundaries_clear(&list);
        return status;
    }
    *out = list;
    return HE_OK;
}

void he_boundaries_clear(he_boundaries *boundaries)
{
    he_mem_free(boundaries->loops);
    *boundaries = (he_boundaries){0};
}

/* --- bow-ties --- */

/* Finds the bow-ties, the vertices with more than one fan of faces. From a vertex on the boundary
 * one boundary half-edge leaves for each fan, so a bow-tie is a vertex that at least two boundary
 * half-edges leave. */
static he_status mark_bowties(const he_mesh *m, uint64_t *once, uint64_t *twice, uint32_t *count,
                              he_error *err)
{
    uint32_t left = m->c.boundary_halfedges, found = 0;
    for (uint32_t h = 0; left > 0 && h < halfedge_end(m); h++) {
        if (m->c.face[h] != HE_NONE) {
            continue;
        }
        left--;
        uint32_t v = m->c.origin[h];
        if (v >= m->c.vertices.issued) {
            return broken(HE_HALFEDGE, h, err);
        }
        if (he_bits_get(once, v) && !he_bits_get(twice, v)) {
            he_bits_set(twice, v);
            found++;
        }
        he_bits_set(once, v);
    }
    *count = found;
    return HE_OK;
}

/* Lists and counts the bow-ties. `list` may be NULL if only their number is needed. */
static he_status find_bowties(const he_mesh *m, he_ids *list, uint32_t *count, he_error *err)
{
    *count = 0;
    if (m->c.boundary_halfedges == 0) {
        return HE_OK;
    }
    uint64_t *once = he_bits_new(m->c.vertices.issued);
    uint64_t *twice = he_bits_new(m->c.vertices.issued);
    he_status status =
        once == NULL || twice == NULL ? no_memory(err) : mark_bowties(m, once, twice, count, err);
    if (status == HE_OK && list != NULL) {
        status = he_ids_reserve(list, *count, err);
        for (uint32_t v = 0; status == HE_OK && v < m->c.vertices.issued; v++) {
            if (he_bits_get(twice, v)) {
                list->ids[list->count++] = v;
            }
        }
    }
    he_mem_free(once);
    he_mem_free(twice);
    return status;
}

he_status he_bowties_find(const he_mesh *m, he_ids *out, he_error *err)
{
    uint32_t count;
    return find_bowties(m, out, &count, err);
}

/* --- the whole topology in one call --- */

/* Counts the faces of each degree (number of corners): faces_of[d] is the number of faces with d
 * corners. The array has an entry for each degree up to the largest. */
static he_status tally(const he_mesh *m, uint32_t **faces_of, size_t *size, he_error *err)
{
    const uint32_t end = halfedge_end(m);
    uint32_t budget = end;
    for (uint32_t f = 0; f < m->c.faces.issued; f++) {
        he_status status = he_progress_at(m->progress, f, m->c.faces.issued, err);
        if (status != HE_OK) {
            return status;
        }
        uint32_t first = m->c.face_halfedge[f], h = first, degree = 0;
        if (first == HE_DEAD) {
            continue;
        }
        do {
            if (h >= end || budget-- == 0) {
                return broken(HE_FACE, f, err);
            }
            degree++;
            h = m->c.next[h];
        } while (h != first);
        if (degree >= *size) {
            size_t grown = he_mem_grown(*size, (size_t)degree + 1);
            uint32_t *array = he_mem_array(*faces_of, grown, sizeof *array);
            if (array == NULL) {
                return no_memory(err);
            }
            for (size_t d = *size; d < grown; d++) {
                array[d] = 0;
            }
            *faces_of = array;
            *size = grown;
        }
        (*faces_of)[degree]++;
    }
    return HE_OK;
}

static he_status find_degrees(const he_mesh *m, he_topology *t, he_error *err)
{
    uint32_t *faces_of = NULL;
    size_t size = 0, distinct = 0;
    he_status status = tally(m, &faces_of, &size, err);
    for (size_t d = 0; d < size; d++) {
        distinct += faces_of[d] > 0;
    }
    if (status == HE_OK) {
        t->degrees = he_mem_array(NULL, distinct, sizeof *t->degrees);
        status = t->degrees == NULL ? no_memory(err) : HE_OK;
    }
    for (size_t d = 0; status == HE_OK && d < size; d++) {
        if (faces_of[d] > 0) {
            t->degrees[t->degree_count++] = (he_degree_count){(uint32_t)d, faces_of[d]};
        }
    }
    he_mem_free(faces_of);
    return status;
}

static uint32_t count_isolated(const he_mesh *m)
{
    uint32_t count = 0;
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        count += m->c.vertex_halfedge[v] == HE_NONE;
    }
    return count;
}

he_status he_topology_find(const he_mesh *m, he_topology *out, he_error *err)
{
    he_topology t = {.vertices = m->c.vertices.live,
                     .edges = m->c.edges.live,
                     .faces = m->c.faces.live,
                     .isolated_vertices = count_isolated(m),
                     .boundary_halfedges = m->c.boundary_halfedges};
    he_boundaries loops = {0};
    uint32_t used = t.vertices - t.isolated_vertices;
    he_status status = he_progress_phase(m->progress, "counting", 0.25, err);
    if (status == HE_OK) {
        status = find_degrees(m, &t, err);
    }
    if (status == HE_OK) {
        status = he_boundaries_find(m, &loops, err);
        t.boundary_loops = (uint32_t)loops.count;
        he_boundaries_clear(&loops);
    }
    if (status == HE_OK) {
        status = find_bowties(m, NULL, &t.bowties, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(m->progress, "connecting", 0.6, err);
    }
    if (status == HE_OK) {
        status = count_components(m, HE_FACE, t.faces, &t.components_by_edge, err);
    }
    /* Faces that are connected through vertices but not across edges exist only if there are
     * bow-ties. Without bow-ties the number of components is therefore equal for both kinds of
     * connection. */
    if (status == HE_OK && t.bowties > 0) {
        status = count_components(m, HE_VERTEX, used, &t.components, err);
    } else {
        t.components = t.components_by_edge;
    }
    if (status != HE_OK) {
        he_topology_clear(&t);
        return status;
    }
    t.closed = t.faces > 0 && t.boundary_halfedges == 0;
    t.manifold = t.faces > 0 && t.bowties == 0;
    t.euler = (int64_t)used - (int64_t)t.edges + (int64_t)t.faces;
    int64_t twice = 2 * (int64_t)t.components - t.euler - (int64_t)t.boundary_loops;
    t.has_genus = t.bowties == 0 && twice >= 0 && twice % 2 == 0;
    t.genus = t.has_genus ? twice / 2 : 0;
    *out = t;
    return HE_OK;
}

void he_topology_clear(he_topology *topology)
{
    he_mem_free(topology->degrees);
    topology->degrees = NULL;
    topology->degree_count = 0;
}
