#include "format/gltf/gltf_private.h"

#include <math.h>
#include <string.h>

static uint32_t find_private(const he_gltf *asset, uint32_t primitive)
{
    const he_json *json = &asset->json;
    return he_json_find(json, he_json_find(json, primitive, "extras"), "hedge");
}

bool he_gltf_has_private(const he_gltf *asset, uint32_t primitive)
{
    return he_json_type(&asset->json, find_private(asset, primitive)) == '{';
}

/* Returns true if a failure is about memory, limits or cancellation and must be reported. Any
 * other failure only means that the extras are not valid; the reader then ignores them. */
static bool is_serious(he_status status)
{
    return status == HE_NO_MEMORY || status == HE_LIMIT || status == HE_CANCELLED;
}

static he_status get_words(he_gltf *asset, uint32_t object, const char *name, he_gltf_accessor *out,
                           bool *fits, he_error *err)
{
    uint32_t value = he_json_find(&asset->json, object, name);
    *fits = false;
    if (value == HE_NONE) {
        return HE_OK;
    }
    /* No error is recorded, because finding the path of the value would cost more than reading it,
     * and the error would not be reported. */
    he_status status = he_gltf_accessor_get(asset, value, out, NULL);
    if (status == HE_OK) {
        *fits = out->components == 1 && out->type == HE_GLTF_UINT32 && out->bytes != NULL;
        return HE_OK;
    }
    return is_serious(status) ? he_gltf_accessor_get(asset, value, out, err) : HE_OK;
}

static uint32_t next_word(he_gltf_walk *walk)
{
    return he_gltf_whole(HE_GLTF_UINT32, he_gltf_next(walk));
}

/* --- polygons --- */

typedef struct polygons {
    he_gltf_accessor degrees, corners;
} polygons;

/* A polygon of n corners was written as n - 2 triangles. Sets *fits to true if the corners of
 * these triangles are corners of the polygon, and no polygon has a vertex twice. `marks` has a
 * word for each vertex, 0 at first. Fails only if the work was cancelled. */
static he_status check_polygons(he_gltf *asset, const he_gltf_primitive *p, const polygons *g,
                                uint32_t *marks, bool *fits, he_error *err)
{
    *fits = false;
    he_gltf_walk degrees = {.accessor = &g->degrees}, corners = {.accessor = &g->corners};
    he_gltf_walk triangles = {.accessor = &p->indices};
    uint64_t corners_left = g->corners.count, triangles_left = p->faces;
    he_status status = HE_OK;
    for (uint64_t i = 0; i < g->degrees.count; i++) {
        uint64_t degree = next_word(&degrees);
        if (degree < 3 || degree > corners_left || degree - 2 > triangles_left) {
            return HE_OK;
        }
        corners_left -= degree;
        triangles_left -= degree - 2;
        for (uint64_t k = 0; k < degree && status == HE_OK; k++) {
            uint32_t corner = next_word(&corners);
            status = he_gltf_poll(asset, err);
            if (corner >= p->vertices || marks[corner] == i + 1) {
                return HE_OK;
            }
            marks[corner] = (uint32_t)i + 1;
        }
        for (uint64_t k = 0; k < 3 * (degree - 2) && status == HE_OK; k++) {
            uint32_t corner = he_gltf_whole(p->indices.type, he_gltf_next(&triangles));
            status = he_gltf_poll(asset, err);
            if (corner >= p->positions.count || marks[he_gltf_vertex(p, corner)] != i + 1) {
                return HE_OK;
            }
        }
        if (status != HE_OK) {
            return status;
        }
    }
    *fits = corners_left == 0 && triangles_left == 0;
    return HE_OK;
}

static he_status add_polygons(he_gltf_surface *s, const he_gltf_primitive *p, const polygons *g,
                              he_error *err)
{
    he_import *into = s->asset->into;
    he_gltf_walk degrees = {.accessor = &g->degrees}, corners = {.accessor = &g->corners};
    uint64_t triangle = 0;
    he_status status = HE_OK;
    for (uint64_t i = 0; i < g->degrees.count && status == HE_OK; i++) {
        uint64_t degree = next_word(&degrees);
        uint64_t place = he_gltf_element_place(s->asset, &p->indices, p->value, 3 * triangle);
        triangle += degree - 2;
        status = he_gltf_poll(s->asset, err);
        if (status == HE_OK) {
            status = he_source_map_add(&into->faces, (uint32_t)into->soup.face_count, place, err);
        }
        if (status == HE_OK) {
            status = he_soup_begin_face(&into->soup, err);
        }
        for (uint64_t k = 0; k < degree && status == HE_OK; k++) {
            status = he_soup_add_corner(&into->soup, p->first_vertex + next_word(&corners), err);
        }
        if (status != HE_OK && err != NULL && err->place == HE_PLACE_NONE) {
            err->place = HE_PLACE_BYTE;
            err->at = place;
        }
    }
    return status;
}

static he_status read_polygons(he_gltf_surface *s, he_gltf_primitive *p, uint32_t object,
                               uint64_t *faces, uint64_t *corners, he_error *err)
{
    polygons g;
    bool fits = false;
    he_status status = get_words(s->asset, object, "degrees", &g.degrees, &fits, err);
    if (status == HE_OK && fits) {
        status = get_words(s->asset, object, "corners", &g.corners, &fits, err);
    }
    if (status == HE_OK && fits) {
        uint64_t words = g.degrees.count * 5 + g.corners.count + p->vertices;
        status = he_gltf_spend(s->asset, object, words * sizeof(uint32_t), err);
    }
    if (status != HE_OK) {
        return status;
    }
    if (fits) {
        uint32_t *marks = he_mem_zero((size_t)p->vertices, sizeof *marks);
        if (marks == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory to check polygons");
        }
        status = check_polygons(s->asset, p, &g, marks, &fits, err);
        he_mem_free(marks);
    }
    if (status != HE_OK) {
        return status;
    }
    if (!fits) {
        he_gltf_note_stale(s->asset, object);
        return HE_OK;
    }
    p->polygons = true;
    *faces = g.degrees.count;
    *corners = g.corners.count;
    return add_polygons(s, p, &g, err);
}

/* --- columns --- */

typedef struct description {
    char name[HE_COLUMN_NAME];
    he_kind domain;
    he_type type;
    he_rule rule;
    uint64_t components;
    uint64_t rows;
    size_t first; /* index in the column of the first value that is read */
    uint32_t labels;
    he_gltf_accessor words;
} description;

static size_t words_of(he_type type)
{
    return type == HE_DOUBLE ? 2 : 1;
}

static he_status describe(he_gltf_surface *s, uint32_t object, description *d, bool *fits,
                          he_error *err)
{
    const he_json *json = &s->asset->json;
    uint32_t type = he_json_find(json, object, "type"), rule = he_json_find(json, object, "rule");
    *fits = false;
    d->type = HE_BOOL;
    d->rule = HE_COPY;
    while (d->type < HE_TYPE_COUNT && !he_json_is(json, type, he_type_name(d->type))) {
        d->type++;
    }
    while (d->rule < HE_RULE_COUNT && !he_json_is(json, rule, he_rule_name(d->rule))) {
        d->rule++;
    }
    if (d->type == HE_TYPE_COUNT || d->rule == HE_RULE_COUNT ||
        he_gltf_need(s->asset, object, "components", (he_gltf_range){1, HE_COLUMN_COMPONENTS},
                     &d->components, NULL) != HE_OK ||
        he_json_string(json, he_json_find(json, object, "name"), d->name, sizeof d->name) == 0) {
        return HE_OK;
    }
    he_gltf_rename(s->asset, d->name, object);
    he_status status = get_words(s->asset, object, "accessor", &d->words, fits, err);
    uint64_t width = d->components * words_of(d->type);
    *fits =
        *fits && d->rows > 0 && d->words.count % width == 0 && d->words.count / width == d->rows;
    d->labels = he_json_find(json, object, "labels");
    if (d->labels != HE_NONE &&
        (d->type != HE_UINT32 || d->components != 1 || he_json_first(json, d->labels) == HE_NONE)) {
        *fits = false;
    }
    return status;
}

/* Reads the labels of a column (names to which its values refer by index). *fits becomes false
 * if a label occurs twice, because a repeated label would shift the indices of all labels after
 * it. */
static he_status read_labels(he_gltf *asset, uint32_t list, he_labels **out, bool *fits,
                             he_error *err)
{
    const he_json *json = &asset->json;
    he_labels *labels = he_labels_new();
    he_status status = HE_OK;
    size_t count = 0;
    if (labels == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for names");
    }
    for (uint32_t i = he_json_first(json, list); i != HE_NONE && status == HE_OK;
         i = he_json_after(json, list, i)) {
        size_t room = 0;
        uint32_t number = 0;
        if (he_json_type(json, i) == '"') {
            he_json_raw(json, i, &room);
        }
        *fits &= he_json_type(json, i) == '"';
        status = he_gltf_spend(asset, i, room, err);
        if (status != HE_OK) {
            break;
        }
        char *text = he_mem_alloc(room + 1);
        if (text == NULL) {
            status = he_fail_plain(err, HE_NO_MEMORY, "no memory for a name of %zu bytes", room);
            break;
        }
        size_t length = he_json_string(json, i, text, room + 1);
        status = he_labels_add(labels, text, length, &number, err);
        he_mem_free(text);
        *fits &= number == count++;
    }
    if (status != HE_OK) {
        he_labels_release(labels);
        return status;
    }
    *out = labels;
    return HE_OK;
}

/* Converts one or two 32-bit words to one component of an attribute's value, and writes it to
 * `at`. Returns false if the words are no value of the attribute's type. */
static bool put_value(he_gltf_walk *walk, he_type type, unsigned char *at)
{
    uint32_t word = next_word(walk);
    switch (type) {
    case HE_BOOL:
        *at = word != 0;
        return word <= 1;
    case HE_FLOAT: {
        float value;
        memcpy(&value, &word, sizeof value);
        memcpy(at, &word, sizeof word);
        return isfinite(value);
    }
    case HE_DOUBLE: {
        uint64_t bits = (uint64_t)next_word(walk) << 32 | word;
        double value;
        memcpy(&value, &bits, sizeof value);
        memcpy(at, &bits, sizeof bits);
        return isfinite(value);
    }
    case HE_INT32:
    case HE_UINT32:
    case HE_TYPE_COUNT:
        break;
    }
    memcpy(at, &word, sizeof word);
    return true;
}

/* Sets *fits to true if all 32-bit words are values of the column's type and, in a column with
 * labels, indices of labels. Fails only if the work was cancelled. */
static he_status check_values(he_gltf *asset, const description *d, size_t labels, bool *fits,
                              he_error *err)
{
    he_gltf_walk walk = {.accessor = &d->words};
    he_status status = HE_OK;
    *fits = false;
    for (uint64_t i = 0; i < d->rows * d->components; i++) {
        unsigned char value[8] = {0};
        uint32_t number;
        if (!put_value(&walk, d->type, value)) {
            return HE_OK;
        }
        memcpy(&number, value, sizeof number);
        if (d->labels != HE_NONE && number >= labels) {
            return HE_OK;
        }
        status = he_gltf_poll(asset, err);
        if (status != HE_OK) {
            return status;
        }
    }
    *fits = true;
    return HE_OK;
}

/* Returns true if the soup has a column that can take the values, or room for a new column. The
 * reader checks this before it reads the values, so that each value of a file is read for one
 * column only. */
static bool has_place(const he_gltf_surface *s, const description *d)
{
    he_soup *soup = &s->asset->into->soup;
    const he_column *column = he_gltf_find_column(soup, d->domain, d->name);
    if (column == NULL) {
        return soup->column_count < HE_GLTF_ATTRIBUTES;
    }
    return column->type == d->type && column->components == d->components &&
           column->rows <= d->first && (column->labels == NULL) == (d->labels == HE_NONE);
}

/* The values from index `first` on are indices into `labels`: replaces them by the indices that
 * these labels have in the column. */
static he_status renumber(he_column *column, size_t first, const he_labels *labels, he_error *err)
{
    size_t count = he_labels_count(labels);
    uint32_t *numbers = he_mem_array(NULL, count, sizeof *numbers);
    he_status status = HE_OK;
    if (numbers == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu names", count);
    }
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        const char *text = he_labels_get(labels, i);
        status = he_labels_add(column->labels, text, strlen(text), &numbers[i], err);
    }
    for (size_t row = first; row < column->rows && status == HE_OK; row++) {
        uint32_t number;
        memcpy(&number, he_column_row(column, row), sizeof number);
        memcpy(he_column_row(column, row), &numbers[number], sizeof number);
    }
    he_mem_free(numbers);
    return status;
}

/* If the column is the face attribute object or material, records that these faces have their
 * names from the extras, and not from nodes or materials. */
static he_status keep_names(he_gltf_surface *s, const description *d, he_error *err)
{
    he_ids *named = strcmp(d->name, "object") == 0     ? &s->own_objects
                    : strcmp(d->name, "material") == 0 ? &s->own_materials
                                                       : NULL;
    if (named == NULL || d->domain != HE_FACE) {
        return HE_OK;
    }
    he_status status = he_ids_reserve(named, 2, err);
    if (status == HE_OK) {
        named->ids[named->count++] = (uint32_t)d->first;
        named->ids[named->count++] = (uint32_t)(d->first + d->rows);
    }
    return status;
}

static he_status take_column(he_gltf_surface *s, uint32_t object, const description *d,
                             he_labels **labels, he_error *err)
{
    he_soup *soup = &s->asset->into->soup;
    he_column *column = he_gltf_find_column(soup, d->domain, d->name);
    bool fresh = column == NULL;
    he_status status = he_soup_column(
        soup, &(he_column_schema){d->name, d->domain, d->type, (uint32_t)d->components, d->rule},
        &column, err);
    if (status == HE_OK) {
        status = he_gltf_extend(s, object, column, d->first + (size_t)d->rows, err);
    }
    if (status != HE_OK) {
        return status;
    }
    if (fresh) {
        column->labels = *labels;
        *labels = NULL;
    }
    he_gltf_walk walk = {.accessor = &d->words};
    for (uint64_t i = 0; i < d->rows && status == HE_OK; i++) {
        unsigned char *at = he_column_row(column, d->first + i);
        for (uint64_t k = 0; k < d->components; k++, at += he_type_bytes(d->type)) {
            put_value(&walk, d->type, at);
        }
        status = he_gltf_poll(s->asset, err);
    }
    if (status == HE_OK && *labels != NULL) {
        status = renumber(column, d->first, *labels, err);
    }
    return status == HE_OK ? keep_names(s, d, err) : status;
}

static he_status read_column(he_gltf_surface *s, const he_gltf_primitive *p, uint32_t object,
                             uint64_t faces, uint64_t corners, he_error *err)
{
    const he_json *json = &s->asset->json;
    uint32_t domain = he_json_find(json, object, "domain");
    description d = {.domain = HE_KIND_COUNT};
    if (he_json_is(json, domain, "vertex")) {
        d = (description){.domain = HE_VERTEX, .rows = p->vertices, .first = p->first_vertex};
    } else if (he_json_is(json, domain, "face")) {
        d = (description){.domain = HE_FACE, .rows = faces, .first = p->first_face};
    } else if (he_json_is(json, domain, "halfedge")) {
        d = (description){.domain = HE_HALFEDGE, .rows = corners, .first = p->first_corner};
    }
    bool fits = false;
    he_labels *labels = NULL;
    he_status status = d.domain == HE_KIND_COUNT ? HE_OK : describe(s, object, &d, &fits, err);
    fits = fits && has_place(s, &d);
    if (status == HE_OK && fits) {
        /* The values are charged to the asset's limit of memory, because all of them are read
         * even if they are not used. */
        status = he_gltf_spend(s->asset, object, d.words.count * sizeof(uint32_t), err);
    }
    if (status == HE_OK && fits && d.labels != HE_NONE) {
        status = read_labels(s->asset, d.labels, &labels, &fits, err);
    }
    if (status == HE_OK && fits) {
        status =
            check_values(s->asset, &d, labels == NULL ? 0 : he_labels_count(labels), &fits, err);
    }
    if (status == HE_OK && fits) {
        status = take_column(s, object, &d, &labels, err);
    } else if (status == HE_OK) {
        he_gltf_note_stale(s->asset, object);
    }
    he_labels_release(labels);
    return status;
}

/* --- copies --- */

static const unsigned char *position_at(const he_gltf_primitive *p, uint64_t i)
{
    return p->positions.bytes + i * p->positions.stride;
}

/* Sets *fits to false if a copy of a vertex is not at the position of the vertex that was
 * copied. Fails only if the work was cancelled. */
static he_status check_copies(he_gltf *asset, const he_gltf_primitive *p,
                              const he_gltf_accessor *copies, bool *fits, he_error *err)
{
    uint64_t vertices = p->positions.count - copies->count;
    size_t bytes = 3 * he_gltf_type_bytes(p->positions.type);
    he_gltf_walk walk = {.accessor = copies};
    he_status status = HE_OK;
    for (uint64_t i = vertices; i < p->positions.count && status == HE_OK && *fits; i++) {
        uint32_t vertex = next_word(&walk);
        *fits = vertex < vertices && memcmp(position_at(p, i), position_at(p, vertex), bytes) == 0;
        status = he_gltf_poll(asset, err);
    }
    return status;
}

he_status he_gltf_open_private(he_gltf_surface *s, he_gltf_primitive *p, he_error *err)
{
    const he_json *json = &s->asset->json;
    uint32_t private = find_private(s->asset, p->value);
    bool fits = p->still && (p->faces == 0 || (p->indexed && p->indices.count == 3 * p->faces));
    he_gltf_accessor copies;
    he_status status = HE_OK;
    if (fits && he_json_find(json, private, "copies") != HE_NONE) {
        status = get_words(s->asset, private, "copies", &copies, &fits, err);
        fits = fits && copies.changed == 0 && copies.count < p->positions.count &&
               p->positions.bytes != NULL && p->positions.changed == 0;
        if (status == HE_OK && fits) {
            status = he_gltf_spend(s->asset, private, copies.count * sizeof(uint32_t), err);
        }
        if (status == HE_OK && fits) {
            status = check_copies(s->asset, p, &copies, &fits, err);
        }
        if (status == HE_OK && fits) {
            p->copies = copies;
            p->vertices = p->positions.count - copies.count;
        }
    }
    p->private = fits;
    if (status == HE_OK && !fits) {
        he_gltf_note_stale(s->asset, private);
    }
    return status;
}

he_status he_gltf_read_private(he_gltf_surface *s, he_gltf_primitive *p, he_error *err)
{
    const he_json *json = &s->asset->json;
    uint32_t private = find_private(s->asset, p->value);
    uint32_t list = he_json_find(json, private, "polygons");
    uint32_t columns = he_json_find(json, private, "columns");
    uint64_t faces = p->faces, corners = 3 * p->faces;
    he_status status = HE_OK;
    if (list != HE_NONE) {
        status = read_polygons(s, p, list, &faces, &corners, err);
        if (status != HE_OK || !p->polygons) {
            return status;
        }
    }
    p->exact = true;
    for (uint32_t i = he_json_first(json, columns); i != HE_NONE && status == HE_OK;
         i = he_json_after(json, columns, i)) {
        status = read_column(s, p, i, faces, corners, err);
    }
    return status;
}
