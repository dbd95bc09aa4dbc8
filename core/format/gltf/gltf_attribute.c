#include "format/gltf/gltf_attribute.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

const he_gltf_semantic he_gltf_semantics[HE_GLTF_SEMANTICS] = {
    {"NORMAL", "normal", 3, 3, false, HE_GLTF_NORMAL, HE_GLTF_NORMAL},
    {"TANGENT", "tangent", 4, 4, false, HE_GLTF_TANGENT, HE_GLTF_TANGENT},
    {"TEXCOORD_", "uv", 2, 2, true, HE_GLTF_UV, HE_GLTF_UV},
    {"COLOR_", "color", 3, 4, true, HE_GLTF_COLOR, HE_GLTF_COLOR},
    {"JOINTS_", "joints", 4, 4, true, HE_GLTF_JOINTS, HE_GLTF_WEIGHTS},
    {"WEIGHTS_", "weights", 4, 4, true, HE_GLTF_WEIGHTS, HE_GLTF_JOINTS},
};

static he_gltf_role role_of(const he_gltf_semantic *known)
{
    return known == NULL ? HE_GLTF_SEMANTICS : known->role;
}

he_column *he_gltf_find_column(const he_soup *soup, he_kind domain, const char *name)
{
    for (size_t i = 0; i < soup->column_count; i++) {
        if (soup->columns[i]->domain == domain && strcmp(soup->columns[i]->name, name) == 0) {
            return soup->columns[i];
        }
    }
    return NULL;
}

he_status he_gltf_extend(he_gltf_surface *surface, uint32_t value, he_column *column, size_t end,
                         he_error *err)
{
    if (end <= column->rows) {
        return HE_OK;
    }
    size_t rows = end - column->rows;
    he_status status =
        he_gltf_spend(surface->asset, value, (uint64_t)rows * column->row_bytes, err);
    return status == HE_OK ? he_column_extend(column, rows, err) : status;
}

void he_gltf_rename(he_gltf *asset, char name[HE_COLUMN_NAME], uint32_t value)
{
    if (strcmp(name, he_position_schema.name) == 0) {
        he_gltf_note_text(asset, "renamed_attribute",
                          "attribute % is renamed to position_1, because position is a reserved "
                          "name",
                          name, value);
        snprintf(name, HE_COLUMN_NAME, "position_1");
    }
}

/* Reads the number at the end of an attribute's name, such as 1 in TEXCOORD_1: at most three
 * digits, and no leading 0. */
static bool read_number(const char *p, unsigned *number)
{
    unsigned value = 0;
    const char *begin = p;
    for (; *p >= '0' && *p <= '9' && p - begin < 3; p++) {
        value = value * 10 + (unsigned)(*p - '0');
    }
    *number = value;
    return p > begin && *p == '\0' && (*begin != '0' || p == begin + 1);
}

/* Finds the name that an attribute gets in the mesh; `semantic` is the attribute's name in glTF,
 * such as TEXCOORD_1. Returns false if the attribute cannot be stored in a mesh. */
static bool name_attribute(const char *semantic, char name[HE_COLUMN_NAME],
                           const he_gltf_semantic **known)
{
    *known = NULL;
    for (size_t i = 0; i < HE_GLTF_SEMANTICS; i++) {
        const he_gltf_semantic *s = &he_gltf_semantics[i];
        size_t length = strlen(s->semantic);
        unsigned number = 0;
        if (strncmp(semantic, s->semantic, length) != 0 ||
            !(s->numbered ? read_number(semantic + length, &number) : semantic[length] == '\0')) {
            continue;
        }
        *known = s;
        snprintf(name, HE_COLUMN_NAME, number == 0 ? "%s" : "%s%u", s->attribute, number);
        return true;
    }
    size_t length = strlen(semantic);
    if (semantic[0] != '_' || length < 2 || length > HE_COLUMN_NAME) {
        return false;
    }
    for (size_t i = 1; i < length; i++) {
        if ((unsigned char)semantic[i] < 0x20 || semantic[i] == 0x7F) {
            return false;
        }
    }
    memcpy(name, semantic + 1, length);
    return true;
}

static he_type column_type(const he_gltf_accessor *a, const he_gltf_semantic *known)
{
    if (role_of(known) == HE_GLTF_UV) {
        return HE_DOUBLE;
    }
    if (a->normalized || a->type == HE_GLTF_FLOAT) {
        return HE_FLOAT;
    }
    return a->type == HE_GLTF_INT8 || a->type == HE_GLTF_INT16 ? HE_INT32 : HE_UINT32;
}

/* --- directions --- */

/* Transforms a normal or tangent by the matrix of its node. Tangents are multiplied by the matrix
 * itself, normals by its cofactors, which are its inverse transpose up to a factor. */
static void turn(const he_gltf_primitive *p, bool normal, double *v)
{
    const double(*m)[4] = p->frame->row;
    double out[3], length = 0;
    for (int i = 0; i < 3; i++) {
        int a = (i + 1) % 3, b = (i + 2) % 3;
        out[i] = 0;
        for (int k = 0; k < 3; k++) {
            int c = (k + 1) % 3, d = (k + 2) % 3;
            double cofactor = m[a][c] * m[b][d] - m[a][d] * m[b][c];
            out[i] += (normal ? (p->mirror ? -cofactor : cofactor) : m[i][k]) * v[k];
        }
        length += out[i] * out[i];
    }
    length = sqrt(length);
    for (int i = 0; i < 3 && length > 0 && isfinite(length); i++) {
        v[i] = out[i] / length;
    }
}

/* --- rows --- */

static void put_row(he_gltf_surface *s, const he_column *column, const double *values, size_t row,
                    uint64_t place)
{
    unsigned char *at = he_column_row(column, row);
    bool fraction = column->type == HE_FLOAT || column->type == HE_DOUBLE;
    for (uint32_t i = 0; i < column->components; i++, at += he_type_bytes(column->type)) {
        double value = values[i];
        if (!(fabs(value) <= (double)FLT_MAX) && fraction) {
            he_warnings_add(
                &s->asset->into->warnings,
                &(he_occurrence){
                    .code = "not_finite",
                    .text = "a value of attribute % is read as 0, because it is not finite",
                    .subject = column->name,
                    .length = strlen(column->name),
                    .place = HE_PLACE_BYTE,
                    .at = place});
            value = 0;
        }
        if (column->type == HE_FLOAT) {
            float number = (float)value;
            memcpy(at, &number, sizeof number);
        } else if (column->type == HE_DOUBLE) {
            memcpy(at, &value, sizeof value);
        } else if (column->type == HE_INT32) {
            int32_t number = (int32_t)value;
            memcpy(at, &number, sizeof number);
        } else {
            uint32_t number = (uint32_t)value;
            memcpy(at, &number, sizeof number);
        }
    }
}

static he_status put_rows(he_gltf_surface *s, const he_gltf_primitive *p, const he_gltf_accessor *a,
                          const he_gltf_semantic *known, const he_column *column, he_error *err)
{
    he_gltf_role role = role_of(known);
    bool normal = role == HE_GLTF_NORMAL, tangent = role == HE_GLTF_TANGENT;
    uint64_t place =
        a->place == HE_GLTF_NOWHERE ? he_json_place(&s->asset->json, a->value) : a->place;
    he_gltf_walk walk = {.accessor = a};
    he_status status = HE_OK;
    for (uint64_t i = 0; i < p->vertices && status == HE_OK; i++) {
        const unsigned char *at = he_gltf_next(&walk);
        double values[HE_COLUMN_COMPONENTS] = {0};
        for (uint32_t k = 0; k < a->components; k++) {
            values[k] = he_gltf_convert(role, k, he_gltf_number(a, at, k));
        }
        if ((normal || tangent) && !p->still) {
            turn(p, normal, values);
            if (tangent && p->mirror) {
                values[3] = -values[3];
            }
        }
        put_row(s, column, values, p->first_vertex + i, place);
        status = he_gltf_poll(s->asset, err);
    }
    return status;
}

static bool is_direction(const he_gltf_semantic *known)
{
    return role_of(known) == HE_GLTF_NORMAL || role_of(known) == HE_GLTF_TANGENT;
}

/* Checks the component type of an attribute. Normals and tangents must be floats, or have a type
 * that KHR_mesh_quantization allows. */
static he_status check_type(const he_gltf *asset, const he_gltf_accessor *a,
                            const he_gltf_semantic *known, he_error *err)
{
    bool small = a->normalized && (a->type == HE_GLTF_INT8 || a->type == HE_GLTF_INT16);
    if (!is_direction(known) || a->type == HE_GLTF_FLOAT || (asset->quantized && small)) {
        return HE_OK;
    }
    return he_json_fail(&asset->json, a->value, err, HE_BAD_VALUE,
                        "%s must have componentType 5126%s, not %d", known->semantic,
                        asset->quantized ? ", or 5120 or 5122 with `normalized`" : "",
                        (int)a->type);
}

/* An attribute of a primitive. */
typedef struct attribute {
    char semantic[HE_COLUMN_NAME + 2]; /* its name in the file */
    he_gltf_accessor values;
    /* The glTF semantic of the attribute; NULL if glTF does not define its name. */
    const he_gltf_semantic *known;
    he_column *column; /* the column of the mesh into which the attribute is read; NULL if it is not
                          read */
} attribute;

/* Finds or makes the column into which an attribute is read. */
static he_status open_column(he_gltf_surface *s, const he_gltf_primitive *p, attribute *out,
                             he_error *err)
{
    he_soup *soup = &s->asset->into->soup;
    const he_gltf_accessor *a = &out->values;
    const char *semantic = out->semantic;
    char name[HE_COLUMN_NAME];
    uint32_t value = a->value;
    out->column = NULL;
    if (!name_attribute(semantic, name, &out->known) || (a->matrix && a->type != HE_GLTF_FLOAT) ||
        (out->known != NULL &&
         (a->components < out->known->least || a->components > out->known->most || a->matrix))) {
        he_gltf_note_text(
            s->asset, "ignored_attribute",
            "attribute % is ignored, because hedge reads no attribute of this name and type",
            semantic, value);
        return HE_OK;
    }
    he_status status = check_type(s->asset, a, out->known, err);
    if (status != HE_OK) {
        return status;
    }
    he_gltf_rename(s->asset, name, value);
    he_type type = column_type(a, out->known);
    he_column *column = he_gltf_find_column(soup, HE_VERTEX, name);
    const he_column *corners = he_gltf_find_column(soup, HE_HALFEDGE, name);
    if (p->exact && corners != NULL && corners->rows > p->first_corner) {
        /* Nothing to do: the attribute was already read from extras, for copies of vertices,
         * too. */
        return HE_OK;
    }
    if (column != NULL && column->rows > p->first_vertex) {
        if (!p->exact) {
            he_gltf_note_text(s->asset, "ignored_attribute",
                              "attribute % is ignored, because another attribute of its primitive "
                              "becomes the same attribute of the mesh",
                              semantic, value);
        }
        return HE_OK;
    }
    if (column != NULL && (column->type != type || column->components != a->components)) {
        he_gltf_note_text(s->asset, "attribute_types",
                          "attribute % of a primitive is ignored, because an earlier primitive "
                          "gives it another type",
                          semantic, value);
        return HE_OK;
    }
    if (column == NULL && soup->column_count == HE_GLTF_ATTRIBUTES) {
        return he_json_fail(&s->asset->json, value, err, HE_LIMIT,
                            "the mesh would have more than %d attributes", (int)HE_GLTF_ATTRIBUTES);
    }
    he_rule rule = type == HE_FLOAT || type == HE_DOUBLE ? HE_INTERPOLATE : HE_COPY;
    return he_soup_column(soup, &(he_column_schema){name, HE_VERTEX, type, a->components, rule},
                          &out->column, err);
}

static size_t number_of(const he_soup *soup, const he_column *column)
{
    size_t i = 0;
    while (soup->columns[i] != column) {
        i++;
    }
    return i;
}

static he_status add_attribute(he_gltf_surface *s, const he_gltf_primitive *p, uint32_t name,
                               he_error *err)
{
    const he_json *json = &s->asset->json;
    uint32_t value = he_json_of(name);
    attribute a = {.known = NULL};
    he_json_string(json, name, a.semantic, sizeof a.semantic);
    he_status status = he_gltf_accessor_get(s->asset, value, &a.values, err);
    if (status == HE_OK && a.values.count != p->positions.count) {
        return he_json_fail(
            json, value, err, HE_BAD_VALUE, "%llu values are given for %llu vertices",
            (unsigned long long)a.values.count, (unsigned long long)p->positions.count);
    }
    if (status == HE_OK) {
        status = open_column(s, p, &a, err);
    }
    size_t end = p->first_vertex + (size_t)p->vertices;
    if (status != HE_OK || a.column == NULL) {
        return status;
    }
    status = he_gltf_extend(s, value, a.column, end, err);
    if (status == HE_OK) {
        s->given[number_of(&s->asset->into->soup, a.column)] += p->vertices;
        status = put_rows(s, p, &a.values, a.known, a.column, err);
    }
    return status;
}

he_status he_gltf_add_attributes(he_gltf_surface *surface, const he_gltf_primitive *p,
                                 he_error *err)
{
    const he_json *json = &surface->asset->json;
    he_status status = HE_OK;
    for (uint32_t i = he_json_first(json, p->attributes); i != HE_NONE && status == HE_OK;
         i = he_json_after(json, p->attributes, i)) {
        if (!he_json_is(json, i, "POSITION")) {
            status = add_attribute(surface, p, i, err);
        }
    }
    return status;
}

void he_gltf_note_attributes(he_gltf_surface *surface)
{
    he_import *into = surface->asset->into;
    for (size_t i = 0; i < into->soup.column_count; i++) {
        const he_column *column = into->soup.columns[i];
        uint64_t given = surface->given[i], all = into->soup.vertex_count;
        if (given == 0 || given == all || column->domain != HE_VERTEX) {
            continue;
        }
        size_t before = into->warnings.count;
        he_warnings_add(
            &into->warnings,
            &(he_occurrence){
                .code = "vertices_without",
                .text =
                    "attribute % is set to 0 at a vertex, because the file gives it no value there",
                .subject = column->name,
                .length = strlen(column->name)});
        if (into->warnings.count > before) {
            into->warnings.items[before].count = all - given;
        }
    }
}
