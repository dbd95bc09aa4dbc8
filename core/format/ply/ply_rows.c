#include "format/ply/ply_rows.h"

#include "format/ply/ply_groups.h"
#include "format/ply/ply_join.h"

#include <float.h>
#include <math.h>
#include <string.h>

static he_status at_place(const he_ply_rows *rows, he_status status, he_error *err)
{
    if (status != HE_OK && err != NULL && err->place == HE_PLACE_NONE) {
        err->place = rows->unit;
        err->at = rows->at;
    }
    return status;
}

/* --- mapping properties to attributes --- */

/* Warns that a property is ignored. `why` is the text of the warning if the property is no list. */
static void note_ignored(const he_ply_rows *rows, const he_ply_property *property, const char *why)
{
    he_warnings_add(
        &rows->into->warnings,
        &(he_occurrence){.code = property->list ? "ignored_list" : "ignored_property",
                         .text = property->list
                                     ? "list property % is ignored, because only lists of vertex "
                                       "indices and texture coordinates are read"
                                     : why,
                         .subject = property->name,
                         .length = strlen(property->name),
                         .place = HE_PLACE_LINE,
                         .at = property->line});
}

static void note_renamed(const he_ply_rows *rows, const he_ply_property *property)
{
    he_warnings_add(&rows->into->warnings,
                    &(he_occurrence){.code = "renamed_property",
                                     .text = "property % becomes an attribute named position_1, "
                                             "because position is a reserved name",
                                     .subject = property->name,
                                     .length = strlen(property->name),
                                     .place = HE_PLACE_LINE,
                                     .at = property->line});
}

static bool has_column(const he_soup *soup, he_kind domain, const char *name)
{
    for (size_t i = 0; i < soup->column_count; i++) {
        if (soup->columns[i]->domain == domain && strcmp(soup->columns[i]->name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* Returns the type that can hold all values of a group's properties; a colour is stored as
 * fractions. */
static he_type type_of_group(const he_ply_property *properties, const size_t *found, size_t count,
                             bool color)
{
    he_type type = HE_TYPE_COUNT;
    for (size_t i = 0; i < count; i++) {
        he_type own = he_ply_type_column(properties[found[i]].type);
        own = color && own != HE_DOUBLE ? HE_FLOAT : own;
        type = i == 0 || own == type ? own : HE_DOUBLE;
    }
    return type;
}

/* Maps the properties of a group, such as nx ny nz, to an attribute. If several groups make one
 * attribute, the first is used whose required properties the element has. */
static he_status map_group(he_ply_rows *rows, const he_ply_element *e, he_kind domain,
                           const he_ply_group *group, he_error *err)
{
    const he_ply_property *properties = rows->header->properties + e->first;
    size_t found[HE_PLY_GROUP], count = 0;
    while (count < group->most) {
        size_t k = he_ply_find(rows->header, e, group->names[count]);
        if (k == e->properties || properties[k].list) {
            break;
        }
        found[count++] = k;
    }
    if (count < group->least || has_column(&rows->into->soup, domain, group->attribute)) {
        return HE_OK;
    }
    he_column *column;
    he_type type = type_of_group(properties, found, count, group->color);
    he_status status = he_soup_column(
        &rows->into->soup,
        &(he_column_schema){group->attribute, domain, type, (uint32_t)count, HE_INTERPOLATE},
        &column, err);
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        double full = group->color ? he_ply_full_color(properties[found[i]].type) : 1;
        rows->targets[e->first + found[i]] =
            (he_ply_target){HE_PLY_ATTRIBUTE, (uint32_t)i, full, column};
    }
    return status;
}

/* Maps each property that is in no group to an attribute of its name. The name position is that of
 * the positions of vertices in the API, so a property of this name is renamed. */
static he_status map_rest(he_ply_rows *rows, const he_ply_element *e, he_kind domain, he_error *err)
{
    he_soup *soup = &rows->into->soup;
    for (size_t k = 0; k < e->properties; k++) {
        const he_ply_property *property = &rows->header->properties[e->first + k];
        he_ply_target *target = &rows->targets[e->first + k];
        if (target->role != HE_PLY_IGNORED) {
            continue;
        }
        const bool reserved = strcmp(property->name, "position") == 0;
        const char *name = reserved ? "position_1" : property->name;
        if (property->list || !property->nameable || has_column(soup, domain, name)) {
            note_ignored(rows, property,
                         property->nameable
                             ? "property % is ignored, because another attribute has its name"
                             : "property % is ignored, because no attribute can have this name");
            continue;
        }
        he_type type = he_ply_type_column(property->type);
        he_rule rule = type == HE_FLOAT || type == HE_DOUBLE ? HE_INTERPOLATE : HE_COPY;
        he_status status = he_soup_column(soup, &(he_column_schema){name, domain, type, 1, rule},
                                          &target->column, err);
        if (status != HE_OK) {
            return status;
        }
        if (reserved) {
            note_renamed(rows, property);
        }
        target->role = HE_PLY_ATTRIBUTE;
        target->full = 1;
    }
    return HE_OK;
}

static he_status map_attributes(he_ply_rows *rows, const he_ply_element *e, he_kind domain,
                                he_error *err)
{
    he_status status = HE_OK;
    for (size_t i = 0; i < HE_PLY_GROUPS && status == HE_OK; i++) {
        status = map_group(rows, e, domain, &he_ply_groups[i], err);
    }
    return status == HE_OK ? map_rest(rows, e, domain, err) : status;
}

static he_status map_position(he_ply_rows *rows, const he_ply_element *e, he_error *err)
{
    static const char *const names[3] = {"x", "y", "z"};
    for (uint32_t i = 0; i < 3; i++) {
        size_t k = he_ply_find(rows->header, e, names[i]);
        if (k == e->properties || rows->header->properties[e->first + k].list) {
            return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, e->line,
                              "vertices have no property '%s'", names[i]);
        }
        rows->targets[e->first + k] = (he_ply_target){HE_PLY_POSITION, i, 1, NULL};
    }
    return HE_OK;
}

static he_status map_corners(he_ply_rows *rows, const he_ply_element *e, he_ply_role role,
                             he_error *err)
{
    size_t k = he_ply_find(rows->header, e, "vertex_indices");
    k = k < e->properties ? k : he_ply_find(rows->header, e, "vertex_index");
    if (k == e->properties) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, e->line,
                          "element '%s' has no list 'vertex_indices' or 'vertex_index'", e->name);
    }
    const he_ply_property *property = &rows->header->properties[e->first + k];
    if (!property->list) {
        return he_fail_at(err, HE_SYNTAX, HE_PLACE_LINE, property->line,
                          "property '%s' is not a list", property->name);
    }
    if (property->type >= HE_PLY_FLOAT) {
        he_warnings_add(&rows->into->warnings,
                        &(he_occurrence){.code = "fraction_indices",
                                         .text = "vertex indices of type % are read, although "
                                                 "indices should have an integer type",
                                         .subject = he_ply_type_name(property->type),
                                         .length = strlen(he_ply_type_name(property->type)),
                                         .place = HE_PLACE_LINE,
                                         .at = property->line});
    }
    rows->targets[e->first + k].role = role;
    return HE_OK;
}

/* Maps lists of two numbers for each corner of a face, which are texture coordinates. A file
 * written by hedge has these also at its vertices, where they are exact. */
static he_status map_uvs(he_ply_rows *rows, const he_ply_element *e, he_error *err)
{
    he_soup *soup = &rows->into->soup;
    size_t k = he_ply_find(rows->header, e, HE_PLY_TEXCOORD);
    const he_ply_property *property = &rows->header->properties[e->first + k];
    if (k == e->properties || !property->list || property->type < HE_PLY_FLOAT) {
        return HE_OK;
    }
    rows->targets[e->first + k].role = HE_PLY_UVS;
    return he_ply_is_of_corners(rows->header, "uv") && has_column(soup, HE_VERTEX, "uv")
               ? HE_OK
               : he_soup_column(soup,
                                &(he_column_schema){"uv", HE_HALFEDGE,
                                                    he_ply_type_column(property->type), 2,
                                                    HE_INTERPOLATE},
                                &rows->uv, err);
}

static he_status map_element(he_ply_rows *rows, const he_ply_element *e, he_error *err)
{
    he_status status = HE_OK;
    if (strcmp(e->name, "vertex") == 0) {
        rows->vertices = e->rows;
        status = map_position(rows, e, err);
        return status == HE_OK ? map_attributes(rows, e, HE_VERTEX, err) : status;
    }
    if (strcmp(e->name, "face") == 0) {
        status = map_corners(rows, e, HE_PLY_CORNERS, err);
        if (status == HE_OK) {
            status = map_uvs(rows, e, err);
        }
        return status == HE_OK ? map_attributes(rows, e, HE_FACE, err) : status;
    }
    if (strcmp(e->name, "tristrips") != 0) {
        he_warnings_add(&rows->into->warnings,
                        &(he_occurrence){.code = "ignored_element",
                                         .text = "element % is ignored, because only vertices, "
                                                 "faces and triangle strips are read",
                                         .subject = e->name,
                                         .length = strlen(e->name),
                                         .place = HE_PLACE_LINE,
                                         .at = e->line});
        return HE_OK;
    }
    status = map_corners(rows, e, HE_PLY_STRIP, err);
    for (size_t k = 0; k < e->properties && status == HE_OK; k++) {
        if (rows->targets[e->first + k].role == HE_PLY_IGNORED) {
            note_ignored(rows, &rows->header->properties[e->first + k],
                         "property % is ignored, because triangle strips have no attributes");
        }
    }
    return status;
}

he_status he_ply_rows_open(he_ply_rows *out, he_import *into, const he_ply_header *header,
                           he_error *err)
{
    bool text = header->encoding == HE_PLY_ASCII;
    he_ply_rows rows = {
        .into = into, .header = header, .unit = text ? HE_PLACE_LINE : HE_PLACE_BYTE};
    rows.targets = he_mem_zero(header->property_count + 1, sizeof *rows.targets);
    he_status status = HE_OK;
    if (rows.targets == NULL) {
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu properties",
                             header->property_count);
    }
    for (size_t i = 0; i < header->count && status == HE_OK; i++) {
        if (header->elements[i].rows > 0) {
            status = map_element(&rows, &header->elements[i], err);
        }
    }
    if (status != HE_OK) {
        he_ply_rows_clear(&rows);
        return status;
    }
    he_source_map_init(&into->vertices, rows.unit, 0);
    he_source_map_init(&into->faces, rows.unit, 0);
    *out = rows;
    return HE_OK;
}

void he_ply_rows_clear(he_ply_rows *rows)
{
    he_mem_free(rows->targets);
    he_mem_free(rows->uvs);
    rows->targets = NULL;
    rows->uvs = NULL;
}

void he_ply_rows_next(he_ply_rows *rows)
{
    const he_ply_header *h = rows->header;
    size_t i = rows->element == NULL ? 0 : (size_t)(rows->element - h->elements) + 1;
    while (i < h->count && h->elements[i].rows == 0) {
        i++;
    }
    const he_ply_element *e = i < h->count ? &h->elements[i] : NULL;
    rows->element = e;
    rows->left = e == NULL ? 0 : e->rows;
    rows->vertex = e != NULL && strcmp(e->name, "vertex") == 0;
    rows->wanted = false;
    for (size_t k = 0; e != NULL && k < e->properties; k++) {
        rows->wanted |= rows->targets[e->first + k].role != HE_PLY_IGNORED;
    }
}

/* --- rows --- */

/* Records where an element begins in the input. The first two elements show the usual distance
 * between elements. */
static he_status add_place(const he_ply_rows *rows, he_source_map *map, size_t element,
                           he_error *err)
{
    if (element == 1 && rows->at - map->runs[0].at <= UINT32_MAX) {
        map->step = (uint32_t)(rows->at - map->runs[0].at);
    }
    return he_source_map_add(map, (uint32_t)element, rows->at, err);
}

/* Extends a column, with defaults, so that it has `end` rows. */
static he_status extend(const he_ply_rows *rows, he_column *column, size_t end, he_error *err)
{
    if (column->rows >= end) {
        return HE_OK;
    }
    uint64_t limit = rows->into->soup.limits.bytes;
    if (limit != 0 && end * (uint64_t)column->row_bytes > limit) {
        return he_fail_plain(err, HE_LIMIT, "attribute %s needs more than %llu bytes of memory",
                             column->name, (unsigned long long)limit);
    }
    return he_column_extend(column, end - column->rows, err);
}

he_status he_ply_rows_begin(he_ply_rows *rows, he_error *err)
{
    const he_ply_element *e = rows->element;
    he_soup *soup = &rows->into->soup;
    he_status status = HE_OK;
    if (rows->vertex) {
        status = add_place(rows, &rows->into->vertices, soup->vertex_count, err);
    }
    rows->row = rows->vertex ? soup->vertex_count : soup->face_count;
    for (size_t k = 0; k < e->properties && status == HE_OK; k++) {
        const he_ply_target *target = &rows->targets[e->first + k];
        if (target->role == HE_PLY_ATTRIBUTE && target->component == 0) {
            status = extend(rows, target->column, rows->row + 1, err);
        }
    }
    return at_place(rows, status, err);
}

/* A float can represent every whole number up to FLOAT_WHOLE, a double up to DOUBLE_WHOLE. */
static const double FLOAT_WHOLE = 1 << 24, DOUBLE_WHOLE = 9007199254740992;

static bool is_whole(double value, double low, double high)
{
    return value >= low && value <= high && value == floor(value);
}

static he_status refuse_value(const he_ply_rows *rows, size_t property, he_error *err)
{
    const he_ply_property *p = &rows->header->properties[rows->element->first + property];
    return he_fail_at(err, HE_BAD_VALUE, rows->unit, rows->at,
                      "a value of property '%s' does not fit its type %s", p->name,
                      he_ply_type_name(p->type));
}

he_status he_ply_rows_value(he_ply_rows *rows, size_t property, double value, he_error *err)
{
    const he_ply_target *target = &rows->targets[rows->element->first + property];
    if (target->role == HE_PLY_POSITION) {
        rows->position[target->component] = value;
    }
    if (target->role != HE_PLY_ATTRIBUTE) {
        return HE_OK;
    }
    he_column *column = target->column;
    bool whole = column->type == HE_INT32 || column->type == HE_UINT32;
    if (!whole && !(fabs(value) <= (column->type == HE_FLOAT ? FLT_MAX : DBL_MAX))) {
        he_warnings_add(&rows->into->warnings,
                        &(he_occurrence){
                            .code = "not_finite",
                            .text = "a value of attribute % is read as 0, because it is not finite",
                            .subject = column->name,
                            .length = strlen(column->name),
                            .place = rows->unit,
                            .at = rows->at});
        value = 0;
    }
    if (target->full != 1) {
        if (!is_whole(value, INT32_MIN, UINT32_MAX)) {
            return refuse_value(rows, property, err);
        }
        value /= target->full;
    }
    unsigned char *at = he_column_row(column, rows->row);
    at += target->component * he_type_bytes(column->type);
    if (column->type == HE_INT32) {
        if (!is_whole(value, INT32_MIN, INT32_MAX)) {
            return refuse_value(rows, property, err);
        }
        int32_t number = (int32_t)value;
        memcpy(at, &number, sizeof number);
    } else if (column->type == HE_UINT32) {
        if (!is_whole(value, 0, UINT32_MAX)) {
            return refuse_value(rows, property, err);
        }
        uint32_t number = (uint32_t)value;
        memcpy(at, &number, sizeof number);
    } else if (column->type == HE_FLOAT) {
        float number = (float)value;
        memcpy(at, &number, sizeof number);
    } else {
        memcpy(at, &value, sizeof value);
    }
    return HE_OK;
}

static he_status begin_face(he_ply_rows *rows, he_error *err)
{
    he_soup *soup = &rows->into->soup;
    he_status status = he_soup_begin_face(soup, err);
    return status == HE_OK ? add_place(rows, &rows->into->faces, soup->face_count - 1, err)
                           : status;
}

he_status he_ply_rows_list(he_ply_rows *rows, size_t property, int64_t count, he_error *err)
{
    uint64_t limit = rows->into->soup.limits.corners;
    if (count < 0 || count > UINT32_MAX) {
        return he_fail_at(err, HE_BAD_VALUE, rows->unit, rows->at, "a list cannot have %lld values",
                          (long long)count);
    }
    switch (he_ply_rows_role(rows, property)) {
    case HE_PLY_CORNERS:
        if (count > HE_MAX_ROWS) {
            return he_fail_at(err, HE_BAD_VALUE, rows->unit, rows->at,
                              "a face has %lld corners, more than a mesh can have",
                              (long long)count);
        }
        if (limit != 0 && (uint64_t)count > limit) {
            return he_fail_at(err, HE_LIMIT, rows->unit, rows->at,
                              "a face has %lld corners, more than the limit of %llu",
                              (long long)count, (unsigned long long)limit);
        }
        return at_place(rows, begin_face(rows, err), err);
    case HE_PLY_STRIP:
        rows->strip_length = 0;
        break;
    case HE_PLY_IGNORED:
    case HE_PLY_POSITION:
    case HE_PLY_ATTRIBUTE:
    case HE_PLY_UVS:
        break;
    }
    return HE_OK;
}

bool he_ply_rows_face(he_ply_rows *rows, const uint32_t *vertices, size_t count, he_status *status,
                      he_error *err)
{
    he_soup *soup = &rows->into->soup;
    he_status added = HE_LIMIT;
    if (soup->limits.corners == 0 || count <= soup->limits.corners) {
        added = he_soup_add_face(soup, vertices, count, err);
    }
    if (added == HE_LIMIT) {
        return false;
    }
    if (added == HE_OK) {
        added = add_place(rows, &rows->into->faces, soup->face_count - 1, err);
        rows->left--;
    }
    *status = at_place(rows, added, err);
    return true;
}

static he_status add_to_strip(he_ply_rows *rows, uint32_t vertex, he_error *err)
{
    uint32_t *strip = rows->strip;
    if (rows->strip_length < 2) {
        strip[rows->strip_length++] = vertex;
        rows->turned = false;
        return HE_OK;
    }
    uint32_t corners[3] = {strip[rows->turned], strip[!rows->turned], vertex};
    he_status status = he_soup_add_face(&rows->into->soup, corners, 3, err);
    if (status == HE_OK) {
        status = add_place(rows, &rows->into->faces, rows->into->soup.face_count - 1, err);
    }
    strip[0] = strip[1];
    strip[1] = vertex;
    rows->turned = !rows->turned;
    return status;
}

he_status he_ply_rows_item(he_ply_rows *rows, size_t property, int64_t value, he_error *err)
{
    he_ply_role role = he_ply_rows_role(rows, property);
    if (role == HE_PLY_STRIP && value == -1) {
        rows->strip_length = 0;
        return HE_OK;
    }
    if (value < 0 || (uint64_t)value >= rows->vertices) {
        if (rows->vertices == 0) {
            return he_fail_at(err, HE_BAD_INDEX, rows->unit, rows->at,
                              "there is no vertex %lld: the file has none", (long long)value);
        }
        return he_fail_at(err, HE_BAD_INDEX, rows->unit, rows->at,
                          "there is no vertex %lld; the vertices are 0 to %lld", (long long)value,
                          (long long)rows->vertices - 1);
    }
    uint32_t vertex = (uint32_t)value;
    return at_place(rows,
                    role == HE_PLY_STRIP ? add_to_strip(rows, vertex, err)
                                         : he_soup_add_corner(&rows->into->soup, vertex, err),
                    err);
}

static he_status add_uv(he_ply_rows *rows, double value, he_error *err)
{
    if (rows->uv_count == rows->uv_capacity) {
        size_t capacity = he_mem_grown(rows->uv_capacity, rows->uv_count + 1);
        double *uvs = he_mem_array(rows->uvs, capacity, sizeof *uvs);
        if (uvs == NULL) {
            return he_fail_plain(err, HE_NO_MEMORY, "no memory for %zu texture coordinates",
                                 capacity);
        }
        rows->uvs = uvs;
        rows->uv_capacity = capacity;
    }
    rows->uvs[rows->uv_count++] = value;
    return HE_OK;
}

static void put_uv(he_ply_rows *rows, size_t corner, uint32_t component, double value)
{
    unsigned char *at = he_column_row(rows->uv, corner);
    if (!(fabs(value) <= (rows->uv->type == HE_FLOAT ? FLT_MAX : DBL_MAX))) {
        he_warnings_add(&rows->into->warnings,
                        &(he_occurrence){
                            .code = "not_finite",
                            .text = "a value of attribute % is read as 0, because it is not finite",
                            .subject = "uv",
                            .length = strlen("uv"),
                            .place = rows->unit,
                            .at = rows->at});
        value = 0;
    }
    float narrow = (float)value;
    memcpy(at + component * he_type_bytes(rows->uv->type),
           rows->uv->type == HE_FLOAT ? (const void *)&narrow : &value,
           he_type_bytes(rows->uv->type));
}

/* Gives the texture coordinates of the face that has just ended to its corners. */
static he_status end_uvs(he_ply_rows *rows, he_error *err)
{
    const he_soup *soup = &rows->into->soup;
    size_t first = soup->starts[soup->face_count - 1], corners = soup->corner_count - first;
    size_t count = rows->uv_count;
    rows->uv_count = 0;
    if (count != 2 * corners) {
        he_warnings_add(
            &rows->into->warnings,
            &(he_occurrence){
                .code = count == 0 ? "faces_without_uv" : "texcoord_count",
                .text = count == 0 ? "the texture coordinates of a face are set to 0, because the "
                                     "file gives none for it"
                                   : "the texture coordinates of a face are set to 0, because the "
                                     "file does not give two numbers for each of its corners",
                .place = rows->unit,
                .at = rows->at});
        return HE_OK;
    }
    he_status status = extend(rows, rows->uv, first + corners, err);
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        put_uv(rows, first + i / 2, (uint32_t)i % 2, rows->uvs[i]);
    }
    return status;
}

he_status he_ply_rows_fraction(he_ply_rows *rows, size_t property, double value, he_error *err)
{
    const he_ply_property *p = &rows->header->properties[rows->element->first + property];
    if (he_ply_rows_role(rows, property) == HE_PLY_UVS) {
        return rows->uv == NULL ? HE_OK : at_place(rows, add_uv(rows, value, err), err);
    }
    double most = p->type == HE_PLY_FLOAT ? FLOAT_WHOLE : DOUBLE_WHOLE;
    if (!is_whole(value, -most, most)) {
        return he_fail_at(err, HE_BAD_INDEX, rows->unit, rows->at,
                          "the %s %.17g is not a vertex index, which must be a whole number",
                          he_ply_type_name(p->type), value);
    }
    return he_ply_rows_item(rows, property, (int64_t)value, err);
}

he_status he_ply_rows_end(he_ply_rows *rows, he_error *err)
{
    const double *p = rows->position;
    he_status status = HE_OK;
    if (rows->vertex) {
        status = he_soup_add_vertex(&rows->into->soup, (he_vec3){p[0], p[1], p[2]}, err);
    } else if (rows->uv != NULL && strcmp(rows->element->name, "face") == 0) {
        status = end_uvs(rows, err);
    }
    rows->left--;
    return at_place(rows, status, err);
}
