/* net_lines.c - makes lines of the held edges of a net, and finds places on lines. */
#include "remesh/net_make.h"

#include "geometry/scale.h"
#include "mesh/marks.h"

/* The state of he_net_find_lines. */
typedef struct finder {
    he_net *n;
    const he_column *feature; /* the mark of the mesh; NULL if it has none */
    uint32_t *two;   /* for each vertex inside a line: a corner of each of its two held edges */
    uint8_t *lines;  /* for each vertex: the number of held edges, 3 for more */
    he_ids chain;    /* the corners of the line that is being followed, each in its direction or
                        the corner of its twin */
    he_ids vertices; /* the vertices of that line; one more than corners */
    size_t line_room, point_room, points;
} finder;

static bool is_line_edge(const he_net *n, uint32_t c)
{
    return (he_net_edge_marks(n, c) & (HE_NET_HELD | HE_NET_FROZEN)) == HE_NET_HELD;
}

/* Returns true if c stands for its edge: it is the one of two twins with the lower number. */
static bool is_first(const he_net *n, uint32_t c)
{
    uint32_t twin = he_net_twin(n, c);
    return twin == HE_NONE || c < twin;
}

static void count_held(finder *f)
{
    const he_net *n = f->n;
    for (uint32_t c = 0; c < 4 * n->triangle_count; c++) {
        if ((c & 3) == 3 || !is_first(n, c) || he_net_edge_marks(n, c) == 0) {
            continue;
        }
        const uint32_t end[2] = {he_net_origin(n, c), he_net_target(n, c)};
        for (unsigned i = 0; i < 2; i++) {
            if (f->lines[end[i]] < 2) {
                f->two[2 * (size_t)end[i] + f->lines[end[i]]] = c;
            }
            if (f->lines[end[i]] < 3) {
                f->lines[end[i]]++;
            }
        }
    }
}

static uint32_t other_end(const he_net *n, uint32_t c, uint32_t v)
{
    uint32_t origin = he_net_origin(n, c);
    return origin == v ? he_net_target(n, c) : origin;
}

/* Returns the angle by which a line turns at a vertex inside it; 0 if a neighbour is at the same
 * place. */
static double turn_at(const finder *f, uint32_t v)
{
    const he_net *n = f->n;
    const uint32_t *two = &f->two[2 * (size_t)v];
    he_vec3 p = he_net_place(n, v);
    he_vec3 in = he_vec3_sub(p, he_net_place(n, other_end(n, two[0], v)));
    he_vec3 out = he_vec3_sub(he_net_place(n, other_end(n, two[1], v)), p);
    return he_vec3_angle(in, out);
}

/* Returns true if both edges of a line at a vertex inside it are marked as features, or none is: a
 * mark stays on the part of a line that was marked. */
static bool is_marked_evenly(const finder *f, uint32_t v)
{
    const uint32_t *two = &f->two[2 * (size_t)v];
    return he_is_marked(f->feature, he_net_halfedge(f->n, two[0]) >> 1) ==
           he_is_marked(f->feature, he_net_halfedge(f->n, two[1]) >> 1);
}

/* Decides which vertices of held edges are inside lines; all others are fixed. */
static void classify(finder *f, double crease)
{
    he_net *n = f->n;
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        he_net_vertex *at = &n->vertices[v];
        if (f->lines[v] == 0 || (at->flags & HE_NET_FIXED) != 0) {
            continue;
        }
        bool inside = f->lines[v] == 2 && turn_at(f, v) <= crease && is_marked_evenly(f, v);
        at->flags |= inside ? HE_NET_LINE : HE_NET_FIXED;
    }
}

static he_status no_memory(const finder *f, he_error *err)
{
    return he_fail_plain(err, HE_NO_MEMORY, "no memory for the feature lines of %u faces",
                         f->n->triangle_count);
}

static he_status make_room(finder *f, size_t points, he_error *err)
{
    he_net_lines *lines = &f->n->lines;
    if (lines->count == f->line_room) {
        size_t room = he_mem_grown(f->line_room, f->line_room + 1);
        he_net_line *line = he_mem_array(lines->line, room, sizeof *line);
        if (line == NULL) {
            return no_memory(f, err);
        }
        lines->line = line;
        f->line_room = room;
    }
    if (f->points + points <= f->point_room) {
        return HE_OK;
    }
    size_t room = he_mem_grown(f->point_room, f->points + points);
    he_vec3 *point = he_mem_array(lines->point, room, sizeof *point);
    lines->point = point != NULL ? point : lines->point;
    double *arc = he_mem_array(lines->arc, room, sizeof *arc);
    lines->arc = arc != NULL ? arc : lines->arc;
    uint32_t *ground = he_mem_array(lines->ground, room, sizeof *ground);
    lines->ground = ground != NULL ? ground : lines->ground;
    if (point == NULL || arc == NULL || ground == NULL) {
        return no_memory(f, err);
    }
    f->point_room = room;
    return HE_OK;
}

/* Adds a line that consists of the followed edges `from` to `to` - 1. */
static he_status add_line(finder *f, size_t from, size_t to, he_error *err)
{
    he_net *n = f->n;
    he_net_lines *lines = &n->lines;
    he_status status = make_room(f, to - from + 1, err);
    if (status != HE_OK) {
        return status;
    }
    const uint32_t *vertex = f->vertices.ids;
    lines->line[lines->count] =
        (he_net_line){(uint32_t)f->points, (uint32_t)(to - from + 1), {vertex[from], vertex[to]}};
    double arc = 0;
    for (size_t i = from; i <= to; i++) {
        he_vec3 p = he_net_place(n, vertex[i]);
        if (i > from) {
            arc += he_vec3_length(he_vec3_sub(p, he_net_place(n, vertex[i - 1])));
        }
        lines->point[f->points] = p;
        lines->arc[f->points] = arc;
        lines->ground[f->points++] = f->chain.ids[i < to ? i : to - 1] >> 2;
        if (i < to) {
            n->line[he_net_halfedge(n, f->chain.ids[i]) >> 1] = lines->count;
        }
        n->arc[vertex[i]] = arc;
    }
    lines->count++;
    return HE_OK;
}

/* Follows a line from vertex v along the edge of corner c, until a fixed vertex or v is reached. */
static he_status follow(finder *f, uint32_t v, uint32_t c, he_error *err)
{
    const he_net *n = f->n;
    uint32_t first = v;
    f->chain.count = f->vertices.count = 0;
    he_status status = he_ids_add(&f->vertices, v, err);
    while (status == HE_OK) {
        status = he_ids_add(&f->chain, c, err);
        v = other_end(n, c, v);
        if (status == HE_OK) {
            status = he_ids_add(&f->vertices, v, err);
        }
        if (v == first || he_net_has(n, v, HE_NET_FIXED)) {
            break;
        }
        const uint32_t *two = &f->two[2 * (size_t)v];
        c = two[0] == c ? two[1] : two[0];
    }
    return status;
}

/* Adds the line that begins at vertex v with the edge of corner c. A closed line is divided at its
 * middle, so that each line has two different ends. */
static he_status begin_line(finder *f, uint32_t v, uint32_t c, he_error *err)
{
    he_net *n = f->n;
    he_status status = follow(f, v, c, err);
    if (status != HE_OK) {
        return status;
    }
    size_t count = f->chain.count;
    const uint32_t *vertex = f->vertices.ids;
    if (vertex[0] != vertex[count]) {
        return add_line(f, 0, count, err);
    }
    size_t half = count / 2;
    n->vertices[vertex[0]].flags |= HE_NET_FIXED;
    n->vertices[vertex[half]].flags |= HE_NET_FIXED;
    n->vertices[vertex[0]].flags &= (uint8_t)~HE_NET_LINE;
    n->vertices[vertex[half]].flags &= (uint8_t)~HE_NET_LINE;
    status = add_line(f, 0, half, err);
    return status == HE_OK ? add_line(f, half, count, err) : status;
}

/* Adds all lines. In the first pass lines that begin at fixed vertices are followed; the lines that
 * are left for the second pass are closed and have no fixed vertex. */
static he_status add_lines(finder *f, he_error *err)
{
    he_net *n = f->n;
    he_status status = HE_OK;
    for (unsigned pass = 0; pass < 2; pass++) {
        for (uint32_t c = 0; c < 4 * n->triangle_count && status == HE_OK; c++) {
            if ((c & 3) == 3 || !is_first(n, c) || !is_line_edge(n, c) ||
                he_net_line_of(n, c) != HE_NONE) {
                continue;
            }
            uint32_t v = he_net_origin(n, c);
            if (pass == 0 && !he_net_has(n, v, HE_NET_FIXED)) {
                v = he_net_target(n, c);
            }
            if (pass == 1 || he_net_has(n, v, HE_NET_FIXED)) {
                status = begin_line(f, v, c, err);
            }
        }
    }
    return status;
}

/* Finds the ideal degrees of vertices on lines and borders, and of fixed vertices: triangles are
 * most regular if each angle is 60 degrees. */
static void find_ideals(he_net *n, double *angle)
{
    for (uint32_t c = 0; c < 4 * n->triangle_count; c++) {
        uint32_t v = (c & 3) == 3 ? HE_NONE : he_net_origin(n, c);
        if (v != HE_NONE && he_net_has(n, v, HE_NET_FIXED | HE_NET_LINE | HE_NET_BORDER)) {
            he_vec3 p = he_net_place(n, v);
            angle[v] += he_vec3_angle(he_vec3_sub(he_net_place(n, he_net_target(n, c)), p),
                                      he_vec3_sub(he_net_place(n, he_net_opposite(n, c)), p));
        }
    }
    for (uint32_t v = 0; v < n->vertex_count; v++) {
        he_net_vertex *at = &n->vertices[v];
        if ((at->flags & (HE_NET_FIXED | HE_NET_LINE | HE_NET_BORDER)) != 0) {
            bool border = (at->flags & HE_NET_BORDER) != 0;
            double faces = fmin(fmax(round(angle[v] / (HE_PI / 3)), border ? 1 : 3), 14);
            at->ideal = (uint8_t)(faces + border);
        }
    }
}

/* Allocates the arrays of lines if there are held edges at all. */
static he_status begin(finder *f, he_error *err)
{
    he_net *n = f->n;
    f->two = he_mem_array(NULL, 2 * (size_t)n->vertex_count + 1, sizeof *f->two);
    f->lines = he_mem_zero((size_t)n->vertex_count + 1, sizeof *f->lines);
    n->arc = he_mem_array(NULL, n->vertex_room, sizeof *n->arc);
    n->line = he_mem_array(NULL, (size_t)n->first_edge + n->edge_room, sizeof *n->line);
    if (f->two == NULL || f->lines == NULL || n->arc == NULL || n->line == NULL) {
        return no_memory(f, err);
    }
    for (size_t e = 0; e < (size_t)n->first_edge + n->edge_room; e++) {
        n->line[e] = HE_NONE;
    }
    for (size_t v = 0; v < n->vertex_room; v++) {
        n->arc[v] = 0;
    }
    return HE_OK;
}

static bool has_held(const he_net *n)
{
    for (uint32_t t = 0; t < n->triangle_count; t++) {
        if ((n->triangles[t].marks & HE_NET_EDGES) != 0) {
            return true;
        }
    }
    return false;
}

he_status he_net_find_lines(he_net *n, const he_mesh *m, double crease, he_error *err)
{
    finder f = {.n = n, .feature = he_mark_find(m, HE_EDGE, "feature")};
    double *angle = he_mem_zero((size_t)n->vertex_count + 1, sizeof *angle);
    he_status status = angle == NULL ? no_memory(&f, err) : HE_OK;
    if (status == HE_OK && has_held(n)) {
        status = begin(&f, err);
        if (status == HE_OK) {
            count_held(&f);
            classify(&f, crease);
            status = add_lines(&f, err);
        }
    }
    if (status == HE_OK) {
        find_ideals(n, angle);
    }
    he_mem_free(angle);
    he_mem_free(f.two);
    he_mem_free(f.lines);
    he_ids_clear(&f.chain);
    he_ids_clear(&f.vertices);
    return status;
}

/* --- places --- */

/* Returns the segment of a line that contains the place `arc`: the index of its first point. */
static uint32_t segment_at(const he_net *n, const he_net_line *line, double arc)
{
    const double *arcs = n->lines.arc + line->first;
    uint32_t low = 0, high = line->count - 1;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (arcs[middle] <= arc) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return line->first + low;
}

he_vec3 he_net_line_place(const he_net *n, uint32_t line, double arc, uint32_t *ground)
{
    const he_net_lines *all = &n->lines;
    uint32_t i = segment_at(n, &all->line[line], arc);
    double length = all->arc[i + 1] - all->arc[i];
    double t = length > 0 ? fmin(fmax((arc - all->arc[i]) / length, 0), 1) : 0;
    *ground = all->ground[i];
    return he_vec3_add(he_vec3_scale(all->point[i], 1 - t), he_vec3_scale(all->point[i + 1], t));
}

double he_net_line_arc(const he_net *n, uint32_t line, uint32_t v)
{
    const he_net_line *of = &n->lines.line[line];
    if (he_net_has(n, v, HE_NET_LINE)) {
        return n->arc[v];
    }
    return v == of->end[0] ? 0 : n->lines.arc[of->first + of->count - 1];
}

double he_net_line_bulge(const he_net *n, uint32_t line, double from, double to)
{
    const he_net_lines *all = &n->lines;
    const he_net_line *of = &all->line[line];
    uint32_t unused;
    double low = fmin(from, to), high = fmax(from, to), most = 0;
    he_vec3 a = he_net_line_place(n, line, low, &unused);
    he_vec3 along = he_vec3_sub(he_net_line_place(n, line, high, &unused), a);
    double square = he_vec3_dot(along, along);
    for (uint32_t i = segment_at(n, of, low) + 1; i < of->first + of->count; i++) {
        if (all->arc[i] >= high) {
            break;
        }
        he_vec3 way = he_vec3_sub(all->point[i], a);
        double t = square > 0 ? fmin(fmax(he_vec3_dot(way, along) / square, 0), 1) : 0;
        most = fmax(most, he_vec3_length(he_vec3_sub(way, he_vec3_scale(along, t))));
    }
    return most;
}
