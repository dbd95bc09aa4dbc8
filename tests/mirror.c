#include "tests/mirror.h"

#include "mesh/column.h"
#include "mesh/material.h"
#include "mesh/walk.h"
#include "tests/json_member.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static const he_kind kinds[] = {HE_VERTEX, HE_HALFEDGE, HE_FACE};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* --- rows and tables --- */

static void drop_column(mirror *m, size_t i)
{
    free(m->columns[i].values);
    free(m->columns[i].labels);
    m->columns[i] = m->columns[--m->column_count];
}

void mirror_clear(mirror *m)
{
    for (size_t kind = 0; kind < HE_KIND_COUNT; kind++) {
        free(m->tables[kind].rows);
    }
    while (m->column_count > 0) {
        drop_column(m, 0);
    }
    free(m->columns);
    free(m->materials);
    *m = (mirror){0};
}

/* Appends a material to the text of the copied table of materials. */
static void add_material(mirror *m, const char *name, const double numbers[9], bool two_sided)
{
    size_t length = m->materials == NULL ? 0 : strlen(m->materials);
    size_t room = length + strlen(name) + 400;
    m->materials = realloc(m->materials, room);
    assert_non_null(m->materials);
    length += (size_t)snprintf(m->materials + length, room - length, "%s %d", name, two_sided);
    for (size_t i = 0; i < 9; i++) {
        length += (size_t)snprintf(m->materials + length, room - length, " %.17g", numbers[i]);
    }
    (void)snprintf(m->materials + length, room - length, "\n");
}

static void take_materials(mirror *m, const he_materials *table)
{
    for (size_t i = 0; i < table->count; i++) {
        if (table->rows[i] != NULL) {
            const he_look *look = &table->rows[i]->look;
            const double numbers[9] = {
                look->base_color[0], look->base_color[1], look->base_color[2],
                look->base_color[3], look->metallic,      look->roughness,
                look->emission[0],   look->emission[1],   look->emission[2]};
            add_material(m, table->rows[i]->name, numbers, look->two_sided);
        }
    }
}

static mirror_row *row_at(mirror *m, he_kind kind, size_t id)
{
    mirror_table *table = &m->tables[kind];
    if (id >= table->count) {
        size_t count = 2 * id + 16;
        table->rows = realloc(table->rows, count * sizeof *table->rows);
        assert_non_null(table->rows);
        memset(table->rows + table->count, 0, (count - table->count) * sizeof *table->rows);
        table->count = count;
    }
    return &table->rows[id];
}

static bool is_live(const mirror *m, he_kind kind, size_t id)
{
    const mirror_table *table = &m->tables[kind == HE_EDGE ? HE_HALFEDGE : kind];
    size_t row = kind == HE_EDGE ? 2 * id : id;
    return kind == HE_MESH_KIND || (row < table->count && table->rows[row].live);
}

static void kill_row(mirror *m, he_kind kind, size_t id)
{
    assert_true(is_live(m, kind, id));
    *row_at(m, kind, id) = (mirror_row){0};
}

size_t mirror_count(const mirror *m, he_kind kind)
{
    size_t live = 0;
    for (size_t i = 0; i < m->tables[kind].count; i++) {
        live += m->tables[kind].rows[i].live;
    }
    return live;
}

uint32_t mirror_live(const mirror *m, he_kind kind, uint32_t from)
{
    bool edge = kind == HE_EDGE;
    const mirror_table *table = &m->tables[edge ? HE_HALFEDGE : kind];
    for (size_t i = 0; i < table->count; i++) {
        size_t row = (from + i) % table->count;
        if (table->rows[row].live) {
            return (uint32_t)(edge ? row / 2 : row);
        }
    }
    return HE_NONE;
}

/* --- attributes, each a column of values --- */

static mirror_column *add_column(mirror *m, he_kind domain, const char *name, size_t components)
{
    m->columns = realloc(m->columns, (m->column_count + 1) * sizeof *m->columns);
    assert_non_null(m->columns);
    mirror_column *column = &m->columns[m->column_count++];
    *column = (mirror_column){.domain = domain, .components = components};
    (void)snprintf(column->name, sizeof column->name, "%s", name);
    return column;
}

static mirror_column *find_column(const mirror *m, he_kind domain, const char *name)
{
    for (size_t i = 0; i < m->column_count; i++) {
        if (m->columns[i].domain == domain && strcmp(m->columns[i].name, name) == 0) {
            return &m->columns[i];
        }
    }
    return NULL;
}

static const double *value_at(const mirror_column *c, size_t row)
{
    return row < c->rows ? c->values + row * c->components : c->fallback;
}

static double *value_of(mirror_column *c, size_t row)
{
    if (row >= c->capacity) {
        c->capacity = 2 * row + 16;
        c->values = realloc(c->values, c->capacity * c->components * sizeof *c->values);
        assert_non_null(c->values);
    }
    for (; c->rows <= row; c->rows++) {
        memcpy(c->values + c->rows * c->components, c->fallback, c->components * sizeof *c->values);
    }
    return c->values + row * c->components;
}

static double component(he_type type, const unsigned char *at)
{
    int32_t whole;
    uint32_t natural;
    float single;
    double number;
    switch (type) {
    case HE_BOOL:
        return *at != 0;
    case HE_INT32:
        memcpy(&whole, at, sizeof whole);
        return whole;
    case HE_UINT32:
        memcpy(&natural, at, sizeof natural);
        return natural;
    case HE_FLOAT:
        memcpy(&single, at, sizeof single);
        return (double)single;
    case HE_DOUBLE:
        memcpy(&number, at, sizeof number);
        return number;
    case HE_TYPE_COUNT:
        break;
    }
    fail();
    return 0;
}

static void add_label(mirror_column *c, const char *label)
{
    size_t length = c->labels == NULL ? 0 : strlen(c->labels), room = length + strlen(label) + 2;
    c->labels = realloc(c->labels, room);
    assert_non_null(c->labels);
    (void)snprintf(c->labels + length, room - length, "%s\n", label);
}

static void take_column(mirror *m, const he_column *from)
{
    mirror_column *c = add_column(m, from->domain, from->name, from->components);
    c->single = from->type == HE_FLOAT;
    size_t bytes = he_type_bytes(from->type);
    for (size_t i = 0; from->labels != NULL && i < he_labels_count(from->labels); i++) {
        add_label(c, he_labels_get(from->labels, i));
    }
    for (size_t k = 0; k < c->components; k++) {
        c->fallback[k] = component(from->type, from->fallback + k * bytes);
    }
    for (size_t row = 0; row < from->rows; row++) {
        double *to = value_of(c, row);
        for (size_t k = 0; k < c->components; k++) {
            to[k] = component(from->type, he_column_value(from, row) + k * bytes);
        }
    }
}

/* --- reading a whole mesh --- */

static void put_vertex(mirror *m, uint32_t id, const double position[3], uint32_t halfedge)
{
    mirror_row row = {.live = true, .link = {halfedge}};
    memcpy(row.position, position, sizeof row.position);
    *row_at(m, HE_VERTEX, id) = row;
}

static void put_links(mirror *m, he_kind kind, uint32_t id, const uint32_t *link, size_t count)
{
    mirror_row row = {.live = true};
    memcpy(row.link, link, count * sizeof *link);
    *row_at(m, kind, id) = row;
}

void mirror_take(mirror *m, const he_mesh *mesh, uint64_t revision)
{
    mirror_clear(m);
    m->revision = revision;
    for (uint32_t i = 0; i < he_mesh_issued(mesh, HE_VERTEX); i++) {
        if (he_mesh_is_live(mesh, HE_VERTEX, i)) {
            he_vec3 p = he_position(mesh, (he_vertex){i});
            put_vertex(m, i, (const double[]){p.x, p.y, p.z},
                       he_vertex_halfedge(mesh, (he_vertex){i}).i);
        }
    }
    for (uint32_t i = 0; i < 2 * he_mesh_issued(mesh, HE_EDGE); i++) {
        he_halfedge h = {i};
        if (he_mesh_is_live(mesh, HE_EDGE, i / 2)) {
            put_links(m, HE_HALFEDGE, i,
                      (const uint32_t[]){he_next(mesh, h).i, he_prev(mesh, h).i,
                                         he_origin(mesh, h).i, he_face_of(mesh, h).i},
                      4);
        }
    }
    for (uint32_t i = 0; i < he_mesh_issued(mesh, HE_FACE); i++) {
        if (he_mesh_is_live(mesh, HE_FACE, i)) {
            put_links(m, HE_FACE, i, &(uint32_t){he_face_halfedge(mesh, (he_face){i}).i}, 1);
        }
    }
    for (size_t i = 0; i < he_mesh_columns(mesh); i++) {
        if (he_mesh_column(mesh, i) != NULL) {
            take_column(m, he_mesh_column(mesh, i));
        }
    }
    take_materials(m, he_mesh_materials(mesh));
}

static uint32_t id_of(const cJSON *item)
{
    assert_true(cJSON_IsNull(item) || cJSON_IsNumber(item));
    return cJSON_IsNull(item) ? HE_NONE : (uint32_t)item->valuedouble;
}

static double number_of(const cJSON *item)
{
    return cJSON_IsTrue(item) ? 1 : cJSON_IsFalse(item) ? 0 : item->valuedouble;
}

static void read_numbers(const cJSON *list, double *out, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        out[i] = number_of(cJSON_GetArrayItem(list, (int)i));
    }
}

/* Rounds the values of a column of floats to float. The shortest text of a float, read as a double,
 * differs from the float. */
static void round_numbers(const mirror_column *c, double *values)
{
    for (size_t k = 0; k < c->components && c->single; k++) {
        values[k] = (double)(float)values[k];
    }
}

void mirror_add_line(mirror *m, he_kind kind, const cJSON *element)
{
    static const char *const links[] = {"next", "prev", "origin", "face"};
    uint32_t id = id_of(json_member(element, "id")), link[MIRROR_LINKS];
    double position[3];
    if (kind == HE_HALFEDGE) {
        for (size_t i = 0; i < MIRROR_LINKS; i++) {
            link[i] = id_of(json_member(element, links[i]));
        }
        put_links(m, kind, id, link, MIRROR_LINKS);
        return;
    }
    link[0] = id_of(json_member(element, "halfedge"));
    if (kind == HE_VERTEX) {
        read_numbers(json_member(element, "position"), position, 3);
        put_vertex(m, id, position, link[0]);
    } else {
        put_links(m, kind, id, link, 1);
    }
}

/* --- applying an event --- */

static he_kind kind_of(const char *plural)
{
    for (he_kind kind = HE_VERTEX; kind < HE_KIND_COUNT; kind++) {
        if (strcmp(he_kind_plural(kind), plural) == 0) {
            return kind;
        }
    }
    fail_msg("\"%s\" is no kind", plural);
    return HE_KIND_COUNT;
}

void mirror_add_attribute(mirror *m, const cJSON *attribute)
{
    mirror_column *c = add_column(m, kind_of(json_member(attribute, "domain")->valuestring),
                                  json_member(attribute, "name")->valuestring,
                                  (size_t)json_member(attribute, "components")->valuedouble);
    const cJSON *fallback = json_member(attribute, "default"), *label;
    c->single = strcmp(json_member(attribute, "type")->valuestring, "float") == 0;
    if (c->components == 1) {
        c->fallback[0] = number_of(fallback);
    } else {
        read_numbers(fallback, c->fallback, c->components);
    }
    round_numbers(c, c->fallback);
    cJSON_ArrayForEach(label, cJSON_GetObjectItem(attribute, "labels"))
    {
        add_label(c, label->valuestring);
    }
}

static void apply_columns(mirror *m, const cJSON *data)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(data, "attributes_dropped"))
    {
        mirror_column *gone = find_column(m, kind_of(json_member(item, "domain")->valuestring),
                                          json_member(item, "name")->valuestring);
        assert_non_null(gone);
        drop_column(m, (size_t)(gone - m->columns));
    }
    cJSON_ArrayForEach(item, cJSON_GetObjectItem(data, "attributes_added"))
    {
        mirror_add_attribute(m, item);
    }
}

void mirror_set_materials(mirror *m, const cJSON *list)
{
    const cJSON *item;
    free(m->materials);
    m->materials = NULL;
    cJSON_ArrayForEach(item, list)
    {
        double numbers[9];
        read_numbers(json_member(item, "base_color"), numbers, 4);
        numbers[4] = json_member(item, "metallic")->valuedouble;
        numbers[5] = json_member(item, "roughness")->valuedouble;
        read_numbers(json_member(item, "emission"), numbers + 6, 3);
        add_material(m, json_member(item, "name")->valuestring, numbers,
                     cJSON_IsTrue(json_member(item, "two_sided")));
    }
}

static void forget_values(mirror *m, he_kind domain, size_t row)
{
    for (size_t i = 0; i < m->column_count; i++) {
        mirror_column *c = &m->columns[i];
        if (c->domain == domain && row < c->rows) {
            memcpy(value_of(c, row), c->fallback, c->components * sizeof *c->values);
        }
    }
}

static void apply_deleted(mirror *m, const cJSON *deleted)
{
    const cJSON *set, *item;
    cJSON_ArrayForEach(set, deleted)
    {
        he_kind kind = kind_of(set->string);
        cJSON_ArrayForEach(item, set)
        {
            size_t id = id_of(item);
            if (kind != HE_EDGE) {
                kill_row(m, kind, id);
                forget_values(m, kind, id);
                continue;
            }
            kill_row(m, HE_HALFEDGE, 2 * id);
            kill_row(m, HE_HALFEDGE, 2 * id + 1);
            forget_values(m, HE_EDGE, id);
            forget_values(m, HE_HALFEDGE, 2 * id);
            forget_values(m, HE_HALFEDGE, 2 * id + 1);
        }
    }
}

static void apply_links(mirror *m, he_kind kind, const cJSON *list)
{
    const cJSON *row;
    size_t count = kind == HE_HALFEDGE ? MIRROR_LINKS : 1;
    cJSON_ArrayForEach(row, list)
    {
        uint32_t link[MIRROR_LINKS];
        assert_int_equal(cJSON_GetArraySize(row), count + 1);
        for (size_t i = 0; i < count; i++) {
            link[i] = id_of(cJSON_GetArrayItem(row, (int)i + 1));
        }
        put_links(m, kind, id_of(row->child), link, count);
    }
}

static void apply_vertices(mirror *m, const cJSON *list)
{
    const cJSON *row;
    cJSON_ArrayForEach(row, list)
    {
        assert_int_equal(cJSON_GetArraySize(row), 5);
        double value[4];
        read_numbers(row, value, 4);
        put_vertex(m, id_of(row->child), value + 1, id_of(cJSON_GetArrayItem(row, 4)));
    }
}

void mirror_add_values(mirror *m, he_kind domain, const char *name, const cJSON *page)
{
    mirror_column *c = find_column(m, domain, name);
    const cJSON *id = json_member(page, "ids")->child, *value = json_member(page, "values")->child;
    assert_non_null(c);
    for (; id != NULL; id = id->next, value = value->next) {
        double *to = value_of(c, id_of(id));
        assert_non_null(value);
        if (c->components == 1) {
            to[0] = number_of(value);
        } else {
            read_numbers(value, to, c->components);
        }
        round_numbers(c, to);
    }
    assert_null(value);
}

static void apply_attributes(mirror *m, const cJSON *attributes)
{
    const cJSON *domain, *list, *row;
    cJSON_ArrayForEach(domain, attributes)
    {
        cJSON_ArrayForEach(list, domain)
        {
            mirror_column *c = find_column(m, kind_of(domain->string), list->string);
            assert_non_null(c);
            cJSON_ArrayForEach(row, list)
            {
                double value[1 + MIRROR_COMPONENTS];
                assert_int_equal(cJSON_GetArraySize(row), c->components + 1);
                read_numbers(row, value, c->components + 1);
                round_numbers(c, value + 1);
                memcpy(value_of(c, (size_t)value[0]), value + 1, c->components * sizeof *c->values);
            }
        }
    }
}

/* Requires that all elements in the sets of an event are live in the copy, or, if `live` is false,
 * that none is. */
static void require_set(const mirror *m, const cJSON *sets, bool live)
{
    const cJSON *set, *item;
    cJSON_ArrayForEach(set, sets)
    {
        cJSON_ArrayForEach(item, set)
        {
            if (is_live(m, kind_of(set->string), id_of(item)) != live) {
                fail_msg("revision %llu: %s %d is %s", (unsigned long long)m->revision, set->string,
                         item->valueint, live ? "dead" : "alive");
            }
        }
    }
}

mirror_step mirror_apply(mirror *m, const cJSON *data)
{
    uint64_t base = (uint64_t)json_member(data, "base")->valuedouble;
    uint64_t revision = (uint64_t)json_member(data, "revision")->valuedouble;
    assert_true(revision == base + 1);
    if (revision <= m->revision) {
        return MIRROR_KNOWN;
    }
    if (base != m->revision || cJSON_GetObjectItem(data, "stale") != NULL) {
        return MIRROR_LOST;
    }
    const cJSON *values = json_member(data, "values");
    require_set(m, json_member(data, "created"), false);
    require_set(m, json_member(data, "modified"), true);
    apply_columns(m, data);
    const cJSON *materials = cJSON_GetObjectItem(data, "materials");
    if (materials !=
        NULL) { /* an event that changes a material contains the whole table of materials */
        mirror_set_materials(m, materials);
    }
    apply_deleted(m, json_member(data, "deleted"));
    apply_vertices(m, json_member(values, "vertices"));
    apply_links(m, HE_HALFEDGE, json_member(values, "halfedges"));
    apply_links(m, HE_FACE, json_member(values, "faces"));
    apply_attributes(m, json_member(values, "attributes"));
    require_set(m, json_member(data, "created"), true);
    require_set(m, json_member(data, "modified"), true);
    require_set(m, json_member(data, "deleted"), false);
    m->revision = revision;
    return MIRROR_APPLIED;
}

/* --- comparing two copies --- */

static mirror_row row_of(const mirror_table *table, size_t i)
{
    return i < table->count ? table->rows[i] : (mirror_row){0};
}

/* Returns whether two lists of numbers have equal bits: minus zero differs from zero, and a NaN
 * equals itself. */
static bool same_bits(const double *a, const double *b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint64_t x, y;
        memcpy(&x, &a[i], sizeof x);
        memcpy(&y, &b[i], sizeof y);
        if (x != y) {
            return false;
        }
    }
    return true;
}

static bool same_row(const mirror_row *a, const mirror_row *b)
{
    return a->live == b->live && memcmp(a->link, b->link, sizeof a->link) == 0 &&
           same_bits(a->position, b->position, 3);
}

static bool same_text(const char *a, const char *b)
{
    return a == NULL || b == NULL ? a == b : strcmp(a, b) == 0;
}

static bool same_column(const mirror *m, const mirror_column *a, const mirror_column *b,
                        char text[MIRROR_TEXT])
{
    size_t rows = a->rows > b->rows ? a->rows : b->rows;
    bool same = a->components == b->components && same_text(a->labels, b->labels) &&
                same_bits(a->fallback, b->fallback, a->components);
    size_t row = 0;
    for (; same && row < rows; row++) {
        same = !is_live(m, a->domain, row) ||
               same_bits(value_at(a, row), value_at(b, row), a->components);
    }
    if (!same) {
        (void)snprintf(text, MIRROR_TEXT, "attribute %s of %s, before row %zu", a->name,
                       he_kind_plural(a->domain), row);
    }
    return same;
}

bool mirror_equal(const mirror *a, const mirror *b, char text[MIRROR_TEXT])
{
    for (size_t k = 0; k < KINDS; k++) {
        const mirror_table *x = &a->tables[kinds[k]], *y = &b->tables[kinds[k]];
        for (size_t i = 0; i < x->count || i < y->count; i++) {
            mirror_row left = row_of(x, i), right = row_of(y, i);
            if (!same_row(&left, &right)) {
                (void)snprintf(text, MIRROR_TEXT, "%s %zu: %s %u %u %u %u, %s %u %u %u %u",
                               he_kind_name(kinds[k]), i, left.live ? "live" : "dead", left.link[0],
                               left.link[1], left.link[2], left.link[3],
                               right.live ? "live" : "dead", right.link[0], right.link[1],
                               right.link[2], right.link[3]);
                return false;
            }
        }
    }
    if (!same_text(a->materials, b->materials)) {
        (void)snprintf(text, MIRROR_TEXT, "materials: %.80s, %.80s",
                       a->materials == NULL ? "none" : a->materials,
                       b->materials == NULL ? "none" : b->materials);
        return false;
    }
    bool same = a->column_count == b->column_count;
    (void)snprintf(text, MIRROR_TEXT, "%zu columns, %zu columns", a->column_count, b->column_count);
    for (size_t i = 0; same && i < a->column_count; i++) {
        const mirror_column *other = find_column(b, a->columns[i].domain, a->columns[i].name);
        same = other != NULL && same_column(a, &a->columns[i], other, text);
    }
    return same;
}
