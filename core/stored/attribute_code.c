#include "stored/attribute_code.h"

#include "base/utf8.h"

#include <assert.h>

/* A domain, type or rule of an attribute is stored as its index in one of these arrays. Their order
 * must never change, even if the enums in column.h do. */
static const he_kind domains[] = {HE_VERTEX, HE_HALFEDGE, HE_EDGE, HE_FACE, HE_MESH_KIND};
static const he_type types[] = {HE_BOOL, HE_INT32, HE_UINT32, HE_FLOAT, HE_DOUBLE};
static const he_rule rules[] = {HE_COPY, HE_INTERPOLATE, HE_DEFAULT};

enum {
    DOMAINS = sizeof domains / sizeof *domains,
    TYPES = sizeof types / sizeof *types,
    RULES = sizeof rules / sizeof *rules
};

static unsigned code_of_domain(he_kind domain)
{
    unsigned code = 0;
    while (domains[code] != domain) {
        code++;
        assert(code < DOMAINS);
    }
    return code;
}

static unsigned code_of_type(he_type type)
{
    unsigned code = 0;
    while (types[code] != type) {
        code++;
        assert(code < TYPES);
    }
    return code;
}

static unsigned code_of_rule(he_rule rule)
{
    unsigned code = 0;
    while (rules[code] != rule) {
        code++;
        assert(code < RULES);
    }
    return code;
}

size_t he_varint_bytes(uint64_t value)
{
    size_t bytes = 1;
    for (; value >= 128; value >>= 7) {
        bytes++;
    }
    return bytes;
}

size_t he_head_bytes(const he_column *column)
{
    return 5 + strlen(column->name) + column->row_bytes;
}

unsigned char *he_head_put(unsigned char *to, const he_column *column)
{
    size_t length = strlen(column->name);
    to = he_put_byte(to, code_of_domain(column->domain));
    to = he_put_byte(to, code_of_type(column->type));
    to = he_put_byte(to, code_of_rule(column->rule));
    to = he_put_byte(to, column->components);
    to = he_put_byte(to, (unsigned)length);
    to = he_put_bytes(to, column->name, length);
    return he_put_bytes(to, column->fallback, column->row_bytes);
}

size_t he_labels_bytes(const he_labels *labels)
{
    if (labels == NULL) {
        return 1;
    }
    size_t count = he_labels_count(labels), bytes = he_varint_bytes((uint64_t)count + 1);
    for (size_t i = 0; i < count; i++) {
        size_t length = strlen(he_labels_get(labels, i));
        bytes += he_varint_bytes(length) + length;
    }
    return bytes;
}

unsigned char *he_labels_put(unsigned char *to, const he_labels *labels)
{
    if (labels == NULL) {
        return he_put_varint(to, 0);
    }
    size_t count = he_labels_count(labels);
    to = he_put_varint(to, (uint64_t)count + 1);
    for (size_t i = 0; i < count; i++) {
        const char *text = he_labels_get(labels, i);
        to = he_put_varint(to, strlen(text));
        to = he_put_bytes(to, text, strlen(text));
    }
    return to;
}

static bool is_text(const unsigned char *bytes, size_t length)
{
    return length == 0 ||
           (memchr(bytes, '\0', length) == NULL && he_is_utf8((const char *)bytes, length));
}

he_status he_head_take(he_cursor *c, he_column **out, he_error *err)
{
    unsigned char fixed[5];
    char name[HE_COLUMN_NAME];
    he_column *column;
    if (!he_take_bytes(c, sizeof fixed, fixed)) {
        return he_refuse_at(c, err, "the stored bytes end inside the description of an attribute");
    }
    size_t length = fixed[4];
    if (fixed[0] >= DOMAINS || fixed[1] >= TYPES || fixed[2] >= RULES || fixed[3] == 0 ||
        fixed[3] > HE_COLUMN_COMPONENTS || length == 0 || length >= HE_COLUMN_NAME) {
        c->at -= sizeof fixed;
        return he_refuse_at(
            c, err,
            "a stored attribute has an unknown domain, type or rule, or an impossible size");
    }
    if (length > he_left(c) || !is_text(c->at, length)) {
        return he_refuse_at(c, err, "the name of a stored attribute is not UTF-8 text");
    }
    (void)he_take_bytes(c, length, name);
    name[length] = '\0';
    he_status status = he_column_new(
        &(he_column_schema){name, domains[fixed[0]], types[fixed[1]], fixed[3], rules[fixed[2]]},
        &column, err);
    if (status != HE_OK) {
        return status;
    }
    if (!he_take_bytes(c, column->row_bytes, column->fallback)) {
        he_column_free(column);
        return he_refuse_at(c, err,
                            "the stored bytes end inside the default value of an attribute");
    }
    *out = column;
    return HE_OK;
}

static he_status take_label(he_cursor *c, he_labels *labels, he_error *err)
{
    uint64_t length;
    uint32_t index;
    size_t count = he_labels_count(labels);
    if (!he_take_varint(c, SIZE_MAX, &length) || length > he_left(c) ||
        !is_text(c->at, (size_t)length)) {
        return he_refuse_at(c, err, "a stored label is not UTF-8 text");
    }
    he_status status = he_labels_add(labels, (const char *)c->at, (size_t)length, &index, err);
    if (status == HE_OK && index != count) {
        return he_refuse_at(c, err, "a stored label appears twice");
    }
    c->at += length;
    return status;
}

he_status he_labels_take(he_cursor *c, he_labels **out, he_error *err)
{
    uint64_t count;
    if (!he_take_varint(c, (uint64_t)he_left(c), &count)) {
        return he_refuse_at(c, err,
                            "a stored attribute declares more labels than its bytes can hold");
    }
    if (count == 0) {
        *out = NULL;
        return HE_OK;
    }
    he_labels *labels = he_labels_new();
    he_status status =
        labels == NULL ? he_fail_plain(err, HE_NO_MEMORY, "no memory for labels") : HE_OK;
    for (uint64_t i = 1; i < count && status == HE_OK; i++) {
        status = take_label(c, labels, err);
    }
    if (status != HE_OK) {
        he_labels_release(labels);
        return status;
    }
    *out = labels;
    return HE_OK;
}

/* --- materials --- */

size_t he_material_code_bytes(const he_material *material)
{
    return HE_MATERIAL_FIXED + he_varint_bytes(material->length) + material->length;
}

unsigned char *he_material_put_head(unsigned char *to, const he_material *material)
{
    const he_look *look = &material->look;
    to = he_put_bytes(to, look->base_color, sizeof look->base_color);
    to = he_put_bytes(to, &look->metallic, sizeof look->metallic);
    to = he_put_bytes(to, &look->roughness, sizeof look->roughness);
    to = he_put_bytes(to, look->emission, sizeof look->emission);
    to = he_put_byte(to, look->two_sided);
    return he_put_varint(to, material->length);
}

he_status he_material_take(he_cursor *c, he_material **out, he_error *err)
{
    he_look look = he_plain_look;
    unsigned char sides = 0;
    uint64_t length = 0;
    he_cursor from = *c;
    bool good = he_take_bytes(c, sizeof look.base_color, look.base_color) &&
                he_take_bytes(c, sizeof look.metallic, &look.metallic) &&
                he_take_bytes(c, sizeof look.roughness, &look.roughness) &&
                he_take_bytes(c, sizeof look.emission, look.emission) &&
                he_take_bytes(c, 1, &sides) && sides <= 1 &&
                he_take_varint(c, HE_MATERIAL_NAME, &length) && length <= he_left(c);
    if (!good) {
        return he_refuse_at(c, err, "a stored material is cut short or malformed");
    }
    look.two_sided = sides == 1;
    he_status status = he_material_new((const char *)c->at, (size_t)length, &look, out, err);
    if (status != HE_OK && status != HE_NO_MEMORY) {
        return he_refuse_at(&from, err,
                            "a stored material has an invalid name or an invalid number");
    }
    c->at += length;
    return status;
}
