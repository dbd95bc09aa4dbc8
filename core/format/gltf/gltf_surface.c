#include "format/gltf/gltf_surface.h"

#include "format/gltf/gltf_attribute.h"
#include "format/gltf/gltf_private.h"

#include <string.h>

const he_gltf_frame he_gltf_no_frame = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

enum { POINTS = 0, TRIANGLES = 4, STRIP = 5, FAN = 6 };

void he_gltf_surface_clear(he_gltf_surface *surface)
{
    he_face_groups_clear(&surface->object);
    he_face_groups_clear(&surface->material);
    he_ids_clear(&surface->own_objects);
    he_ids_clear(&surface->own_materials);
}

/* --- reading a primitive --- */

static he_status get_mode(const he_gltf *asset, uint32_t primitive, uint64_t *mode, he_error *err)
{
    uint32_t value = he_json_find(&asset->json, primitive, "mode");
    *mode = TRIANGLES;
    return value == HE_NONE ? HE_OK : he_json_whole(&asset->json, value, POINTS, FAN, mode, err);
}

/* Gets an accessor of a primitive. If its data exists only with Draco compression, the accessor has
 * no bytes; that is refused with a message of its own. */
static he_status get_whole(he_gltf *asset, uint32_t primitive, uint32_t value,
                           he_gltf_accessor *out, he_error *err)
{
    const he_json *json = &asset->json;
    uint32_t packed = he_json_find(json, he_json_find(json, primitive, "extensions"),
                                   "KHR_draco_mesh_compression");
    he_status status = he_gltf_accessor_get(asset, value, out, err);
    if (status == HE_OK && packed != HE_NONE && out->bytes == NULL) {
        return he_json_fail(json, packed, err, HE_UNSUPPORTED,
                            "the primitive is stored only with Draco compression, which is not "
                            "supported: " HE_GLTF_UNDRACO);
    }
    return status;
}

static he_status get_positions(he_gltf *asset, he_gltf_primitive *p, uint32_t value, he_error *err)
{
    he_gltf_accessor *a = &p->positions;
    he_status status = get_whole(asset, p->value, value, a, err);
    if (status == HE_OK && (a->components != 3 || a->matrix || a->type == HE_GLTF_UINT32)) {
        return he_json_fail(&asset->json, a->value, err, HE_BAD_VALUE,
                            "positions must be VEC3 of floats, or of bytes or shorts");
    }
    return status;
}

static he_status get_indices(he_gltf *asset, he_gltf_primitive *p, uint32_t value, he_error *err)
{
    he_gltf_accessor *a = &p->indices;
    he_status status = get_whole(asset, p->value, value, a, err);
    bool whole = a->type == HE_GLTF_UINT8 || a->type == HE_GLTF_UINT16 || a->type == HE_GLTF_UINT32;
    if (status == HE_OK && (a->components != 1 || !whole)) {
        return he_json_fail(&asset->json, a->value, err, HE_BAD_VALUE,
                            "indices must be SCALAR with componentType 5121, 5123 or 5125");
    }
    p->indexed = true;
    return status;
}

static he_status count_faces(const he_gltf *asset, he_gltf_primitive *p, he_error *err)
{
    uint64_t corners = p->indexed ? p->indices.count : p->positions.count;
    if (p->mode == TRIANGLES && corners % 3 != 0) {
        return he_json_fail(&asset->json, p->value, err, HE_BAD_VALUE,
                            "%llu corners do not make a whole number of triangles",
                            (unsigned long long)corners);
    }
    p->faces = p->mode < TRIANGLES    ? 0
               : p->mode == TRIANGLES ? corners / 3
               : corners < 3          ? 0
                                      : corners - 2;
    return HE_OK;
}

/* --- places --- */

uint64_t he_gltf_element_place(const he_gltf *asset, const he_gltf_accessor *a, uint32_t value,
                               uint64_t i)
{
    bool known = a->bytes != NULL && a->place != HE_GLTF_NOWHERE;
    return known ? a->place + i * a->stride : he_json_place(&asset->json, value);
}

static uint32_t step_of(const he_gltf *asset, const he_gltf_accessor *a, uint32_t value,
                        uint64_t each)
{
    return (uint32_t)(he_gltf_element_place(asset, a, value, each) -
                      he_gltf_element_place(asset, a, value, 0));
}

static he_status located(he_status status, uint64_t at, he_error *err)
{
    if (status != HE_OK && err != NULL && err->place == HE_PLACE_NONE) {
        err->place = HE_PLACE_BYTE;
        err->at = at;
    }
    return status;
}

/* --- vertices and faces --- */

/* Charges the memory that a primitive takes to the asset's limit: memory of the soup, and of
 * he_source_map, in which an element takes memory if its distance in the file from the element
 * before is unusual. */
static he_status spend(he_gltf_surface *s, const he_gltf_primitive *p, he_error *err)
{
    he_import *into = s->asset->into;
    const he_gltf_accessor *corners = p->indexed ? &p->indices : &p->positions;
    uint32_t vertex_step = step_of(s->asset, &p->positions, p->value, 1);
    uint32_t face_step = step_of(s->asset, corners, p->value, p->mode == TRIANGLES ? 3 : 1);
    if (!s->begun) {
        s->begun = true;
        he_source_map_init(&into->vertices, HE_PLACE_BYTE, vertex_step);
        he_source_map_init(&into->faces, HE_PLACE_BYTE, face_step);
    }
    uint64_t vertex = sizeof(he_vec3), face = 4 * sizeof(uint32_t);
    vertex += into->vertices.step == vertex_step ? 0 : sizeof(he_source_run);
    face += into->faces.step == face_step ? 0 : sizeof(he_source_run);
    return he_gltf_spend(s->asset, p->value, p->vertices * vertex + p->faces * face, err);
}

static he_vec3 place_point(const he_gltf_frame *frame, he_vec3 p)
{
    double out[3];
    for (int i = 0; i < 3; i++) {
        const double *r = frame->row[i];
        out[i] = r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
    }
    return (he_vec3){out[0], out[1], out[2]};
}

static he_status add_vertices(he_gltf_surface *s, const he_gltf_primitive *p, he_error *err)
{
    he_import *into = s->asset->into;
    he_gltf_walk walk = {.accessor = &p->positions};
    he_status status = HE_OK;
    for (uint64_t i = 0; i < p->vertices && status == HE_OK; i++) {
        const unsigned char *at = he_gltf_next(&walk);
        uint64_t place = he_gltf_element_place(s->asset, &p->positions, p->value, i);
        double n[3];
        for (uint32_t k = 0; k < 3; k++) {
            n[k] = he_gltf_number(&p->positions, at, k);
        }
        he_vec3 position = {n[0], n[1], n[2]};
        if (!p->still) {
            position = place_point(p->frame, position);
        }
        status = he_gltf_poll(s->asset, err);
        if (status == HE_OK) {
            status =
                he_source_map_add(&into->vertices, (uint32_t)into->soup.vertex_count, place, err);
        }
        if (status == HE_OK) {
            status = located(he_soup_add_vertex(&into->soup, position, err), place, err);
        }
    }
    return status;
}

static he_status add_face(he_gltf_surface *s, const he_gltf_primitive *p, const uint32_t *corners,
                          uint64_t place, he_error *err)
{
    he_import *into = s->asset->into;
    uint32_t turned[3] = {corners[0], corners[p->mirror ? 2 : 1], corners[p->mirror ? 1 : 2]};
    he_status status = he_source_map_add(&into->faces, (uint32_t)into->soup.face_count, place, err);
    return status == HE_OK ? located(he_soup_add_face(&into->soup, turned, 3, err), place, err)
                           : status;
}

static he_status bad_index(const he_gltf_surface *s, const he_gltf_primitive *p, uint64_t i,
                           uint32_t index, he_error *err)
{
    he_status status =
        he_json_fail(&s->asset->json, p->value, err, HE_BAD_INDEX,
                     "index %u (number %llu) is out of range: there are %llu vertices", index,
                     (unsigned long long)i, (unsigned long long)p->positions.count);
    if (err != NULL) {
        err->at = he_gltf_element_place(s->asset, &p->indices, p->value, i);
    }
    return status;
}

/* Finds the corners of triangle i of a strip or fan. `held` has the first corner that was read and
 * the last three. */
static void corners_of(uint64_t mode, uint64_t i, const uint32_t held[4], uint32_t corners[3])
{
    bool odd = i % 2 == 1;
    if (mode == FAN) {
        memcpy(corners, (uint32_t[]){held[2], held[3], held[0]}, 3 * sizeof *corners);
    } else {
        memcpy(corners, (uint32_t[]){held[1], held[odd ? 3 : 2], held[odd ? 2 : 3]},
               3 * sizeof *corners);
    }
}

static he_status add_faces(he_gltf_surface *s, const he_gltf_primitive *p, he_error *err)
{
    he_gltf_walk walk = {.accessor = &p->indices};
    const he_gltf_accessor *source = p->indexed ? &p->indices : &p->positions;
    uint64_t count = source->count, faces = 0;
    uint32_t held[4] = {0}, corners[3]; /* `held`: the first corner read, and the last three */
    he_status status = HE_OK;
    for (uint64_t i = 0; i < count && status == HE_OK; i++) {
        uint32_t index = (uint32_t)i;
        status = he_gltf_poll(s->asset, err);
        if (status != HE_OK) {
            return status;
        }
        if (p->indexed) {
            index = he_gltf_whole(p->indices.type, he_gltf_next(&walk));
        }
        if (index >= p->positions.count) {
            return bad_index(s, p, i, index, err);
        }
        index = he_gltf_vertex(p, index) + p->first_vertex;
        held[0] = i == 0 ? index : held[0];
        held[1] = held[2];
        held[2] = held[3];
        held[3] = index;
        if (p->mode == TRIANGLES) {
            if (i % 3 == 2) {
                status = add_face(s, p, held + 1,
                                  he_gltf_element_place(s->asset, source, p->value, i - 2), err);
            }
        } else if (i >= 2) {
            corners_of(p->mode, faces++, held, corners);
            status = add_face(s, p, corners,
                              he_gltf_element_place(s->asset, source, p->value, i - 2), err);
        }
    }
    return status;
}

/* --- labels --- */

static he_status set_material(he_gltf_surface *s, const he_gltf_primitive *p, he_error *err)
{
    const he_json *json = &s->asset->json;
    uint32_t value = he_json_find(json, p->value, "material"), material = HE_NONE;
    uint64_t index = 0;
    const char *name = "";
    he_status status = HE_OK;
    if (value != HE_NONE) {
        status = he_gltf_item(s->asset, &s->asset->materials, value, "material", &material, err);
        if (status == HE_OK) {
            status = he_json_whole(json, value, 0, HE_JSON_WHOLE, &index, err);
        }
        name = status == HE_OK ? he_labels_get(s->names, index) : "";
    }
    return status == HE_OK
               ? he_face_groups_set_label(&s->material, p->first_face, name, strlen(name), err)
               : status;
}

static he_status set_object(he_gltf_surface *s, const he_gltf_primitive *p, uint32_t value,
                            he_error *err)
{
    char name[HE_GLTF_NAME];
    size_t length = he_json_string(&s->asset->json, value, name, sizeof name);
    return he_face_groups_set_label(&s->object, p->first_face, name, length, err);
}

/* --- the whole --- */

static double determinant(const he_gltf_frame *frame)
{
    const double(*m)[4] = frame->row;
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static bool is_still(const he_gltf_frame *frame)
{
    bool same = true;
    for (size_t i = 0; i < 12; i++) {
        same &= frame->row[i / 4][i % 4] == he_gltf_no_frame.row[i / 4][i % 4];
    }
    return same;
}

he_status he_gltf_add_primitive(he_gltf_surface *s, uint32_t value, uint32_t name,
                                const he_gltf_frame *frame, he_error *err)
{
    he_gltf *asset = s->asset;
    const he_json *json = &asset->json;
    he_soup *soup = &asset->into->soup;
    he_gltf_primitive p = {.value = value,
                           .frame = frame,
                           .still = is_still(frame),
                           .mirror = determinant(frame) < 0,
                           .first_vertex = (uint32_t)soup->vertex_count,
                           .first_face = (uint32_t)soup->face_count,
                           .first_corner = (uint32_t)soup->corner_count};
    he_status status = he_gltf_spend(asset, value, 8 * he_json_span(json, value), err);
    if (status == HE_OK) {
        status = get_mode(asset, value, &p.mode, err);
    }
    p.attributes = he_json_find(json, value, "attributes");
    if (status == HE_OK && he_json_type(json, p.attributes) != '{') {
        status = he_json_fail(json, value, err, HE_BAD_VALUE, "'attributes' is missing");
    }
    uint32_t positions = he_json_find(json, p.attributes, "POSITION");
    uint32_t indices = he_json_find(json, value, "indices");
    if (status == HE_OK && positions == HE_NONE) {
        he_gltf_note(asset, "no_positions", "a primitive is skipped, because it has no positions",
                     HE_NONE, value);
        return HE_OK;
    }
    if (status == HE_OK) {
        status = get_positions(asset, &p, positions, err);
    }
    if (status == HE_OK && indices != HE_NONE) {
        status = get_indices(asset, &p, indices, err);
    }
    if (status == HE_OK) {
        status = count_faces(asset, &p, err);
    }
    if (status != HE_OK) {
        return status;
    }
    if (p.mode < TRIANGLES && !(p.mode == POINTS && he_gltf_has_private(asset, value))) {
        he_gltf_note(asset, p.mode == POINTS ? "skipped_points" : "skipped_lines",
                     p.mode == POINTS
                         ? "a primitive of points is skipped, because a mesh is made of faces"
                         : "a primitive of lines is skipped, because a mesh is made of faces",
                     HE_NONE, value);
        return HE_OK;
    }
    if (he_json_first(json, he_json_find(json, value, "targets")) != HE_NONE) {
        he_gltf_note(asset, "ignored_targets",
                     "the morph targets of a primitive are ignored, because a mesh stores none",
                     HE_NONE, value);
    }
    p.vertices = p.positions.count;
    status = he_gltf_has_private(asset, value) ? he_gltf_open_private(s, &p, err) : HE_OK;
    if (status == HE_OK) {
        status = spend(s, &p, err);
    }
    if (status == HE_OK) {
        status = set_object(s, &p, name, err);
    }
    if (status == HE_OK) {
        status = set_material(s, &p, err);
    }
    if (status == HE_OK) {
        status = add_vertices(s, &p, err);
    }
    if (status == HE_OK && p.private) {
        status = he_gltf_read_private(s, &p, err);
    }
    if (status == HE_OK && p.mode >= TRIANGLES && !p.polygons) {
        status = add_faces(s, &p, err);
    }
    if (status == HE_OK) {
        status = he_gltf_add_attributes(s, &p, err);
    }
    s->mirrored += p.mirror ? p.faces : 0;
    return status;
}

he_status he_gltf_add_mesh(he_gltf_surface *surface, uint32_t mesh, uint32_t name,
                           const he_gltf_frame *frame, he_error *err)
{
    const he_json *json = &surface->asset->json;
    uint32_t primitives = he_json_find(json, mesh, "primitives");
    he_status status = HE_OK;
    if (he_json_type(json, primitives) != '[') {
        return he_json_fail(json, mesh, err, HE_BAD_VALUE, "'primitives' is missing");
    }
    for (uint32_t i = he_json_first(json, primitives); i != HE_NONE && status == HE_OK;
         i = he_json_after(json, primitives, i)) {
        status = he_json_type(json, i) == '{'
                     ? he_gltf_add_primitive(surface, i, name, frame, err)
                     : he_json_fail(json, i, err, HE_BAD_VALUE, "the value is not an object");
    }
    return status;
}

/* Makes the face attribute `name`, which is "object" or "material". Names from extras, which some
 * faces have, take precedence over those from nodes and materials. */
static he_status finish_names(he_gltf_surface *surface, he_face_groups *groups, const he_ids *own,
                              const char *name, he_error *err)
{
    he_import *into = surface->asset->into;
    he_soup *soup = &into->soup;
    he_column *column = he_gltf_find_column(soup, HE_FACE, name);
    if (column == NULL) {
        return he_face_groups_finish(groups, soup, name, err);
    }
    if (column->labels != NULL) {
        return he_face_groups_merge(groups, soup->face_count, column, own, err);
    }
    if (groups->changes.count > 0) {
        he_warnings_add(&into->warnings,
                        &(he_occurrence){.code = "attribute_types",
                                         .text = "names in the file are not stored as attribute %, "
                                                 "because the file also gives it numbers",
                                         .subject = name,
                                         .length = strlen(name)});
    }
    return HE_OK;
}

he_status he_gltf_surface_finish(he_gltf_surface *surface, he_error *err)
{
    he_import *into = surface->asset->into;
    he_warnings_add_count(&into->warnings, "mirrored",
                          "a face is reversed, because its node mirrors it", surface->mirrored);
    he_gltf_note_attributes(surface);
    he_status status =
        finish_names(surface, &surface->object, &surface->own_objects, "object", err);
    if (status == HE_OK) {
        status =
            finish_names(surface, &surface->material, &surface->own_materials, "material", err);
    }
    return status;
}
