#include "edit_script.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "build/build.h"
#include "edit/piece/point.h"
#include "mesh/check.h"
#include "mesh/write.h"
#include "tests/failing.h"
#include "geometry/geometry.h"

enum { MAX_LIST = 64, MAX_TEXT = 256 };

static uint32_t digit(char c)
{
    return (uint32_t)(c >= 'a' ? c - 'a' + 10 : c - '0');
}

he_mesh *script_mesh(const char *faces, const he_vec3 *positions)
{
    he_soup soup;
    he_soup_init(&soup, NULL);
    uint32_t count = 0, extra = 0;
    for (const char *c = faces; *c != '\0'; c++) {
        if (*c == '+') {
            extra++;
        } else if (*c != ',' && digit(*c) >= count) {
            count = digit(*c) + 1;
        }
    }
    for (uint32_t i = 0; i < count + extra; i++) {
        double x = i;
        he_vec3 p = positions != NULL ? positions[i] : (he_vec3){x, x * x / 8, x * x * x / 64};
        assert_int_equal(he_soup_add_vertex(&soup, p, NULL), HE_OK);
    }
    uint32_t corners[MAX_LIST];
    size_t n = 0;
    for (const char *c = faces;; c++) {
        if (*c == '\0' || *c == ',' || *c == '+') {
            if (n > 0) {
                assert_int_equal(he_soup_add_face(&soup, corners, n, NULL), HE_OK);
            }
            n = 0;
            if (*c == '\0') {
                break;
            }
        } else {
            corners[n++] = digit(*c);
        }
    }
    he_mesh *m = NULL;
    he_error err = {.status = HE_OK};
    he_status status = he_build(&soup, 0, &m, NULL, &err);
    if (status != HE_OK) {
        fail_msg("%s: %s", faces, err.text);
    }
    he_soup_clear(&soup);
    return m;
}

he_halfedge halfedge_between(const he_mesh *m, uint32_t a, uint32_t b)
{
    he_halfedge h = he_find_halfedge(m, (he_vertex){a}, (he_vertex){b});
    if (h.i == HE_NONE) {
        fail_msg("no edge joins %u and %u", a, b);
    }
    return h;
}

he_edge edge_between(const he_mesh *m, uint32_t a, uint32_t b)
{
    return he_edge_of(halfedge_between(m, a, b));
}

void script_add_columns(he_mesh *m)
{
    static const he_kind domains[] = {HE_VERTEX, HE_HALFEDGE, HE_EDGE, HE_FACE};
    for (unsigned i = 0; i < 12; i++) {
        char name[16];
        snprintf(name, sizeof name, "c%u", i);
        if (i == 5 || i == 11) { /* column 5 holds attributes of half-edges, column 11 holds
                                    attributes of faces */
            snprintf(name, sizeof name, "normal");
        }
        he_column *column = NULL;
        assert_int_equal(
            he_column_new(&(he_column_schema){name, domains[i % 4], i % 2 ? HE_DOUBLE : HE_UINT32,
                                              1 + i % 3, (he_rule)(i / 4)},
                          &column, NULL),
            HE_OK);
        size_t rows = he_mesh_issued(m, domains[i % 4]);
        assert_int_equal(he_column_extend(column, rows, NULL), HE_OK);
        for (size_t row = 0; row < rows; row++) {
            if (he_mesh_is_live(m, domains[i % 4], (uint32_t)row)) {
                double number = (double)(row + i);
                uint32_t whole = (uint32_t)row + i;
                memcpy(he_column_row(column, row), i % 2 ? (void *)&number : (void *)&whole,
                       i % 2 ? 8 : 4);
            }
        }
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    }
}

/* --- operations --- */

typedef struct storage {
    uint32_t ids[HE_OP_PARAMS][MAX_LIST];
    he_vec3 points[HE_OP_PARAMS][MAX_LIST];
    char texts[HE_OP_PARAMS][MAX_TEXT];
} storage;

static uint32_t parse_id(const he_mesh *m, he_kind kind, const char **at)
{
    if (strncmp(*at, "null", 4) == 0) {
        *at += 4;
        return HE_NONE;
    }
    char *end;
    bool direct = **at == '#';
    uint32_t a = (uint32_t)strtoul(*at + direct, &end, 10);
    if (!direct && *end == '-') {
        uint32_t b = (uint32_t)strtoul(end + 1, &end, 10);
        he_halfedge h = halfedge_between(m, a, b);
        a = kind == HE_EDGE ? h.i >> 1 : h.i;
    }
    *at = end;
    return a;
}

static size_t parse_ids(const he_mesh *m, he_kind kind, const char *text, uint32_t *ids)
{
    size_t count = 0;
    while (*text != '\0') {
        ids[count++] = parse_id(m, kind, &text);
        text += *text == ',';
    }
    return count;
}

static size_t parse_numbers(const char *text, double *numbers)
{
    size_t count = 0;
    while (*text != '\0') {
        char *end;
        numbers[count++] = strtod(text, &end);
        text = end + (*end == ',');
    }
    return count;
}

/* Makes a mesh from a list of faces such as "012,023", in which each digit or letter is a vertex.
 * The function does not use the code under test. */
static he_mesh *other_mesh(const char *text)
{
    char faces[MAX_TEXT];
    size_t length = strcspn(text, "*!");
    snprintf(faces, sizeof faces, "%.*s", (int)length, text);
    failing_pause();
    he_mesh *other = script_mesh(faces, NULL);
    if (text[length] == '*') {
        he_column *column = NULL;
        script_add_columns(other);
        assert_int_equal(he_column_new(&(he_column_schema){"locked", HE_FACE, HE_INT32, 1, HE_COPY},
                                       &column, NULL),
                         HE_OK);
        assert_int_equal(he_mesh_add_column(other, column, NULL), HE_OK);
    } else if (text[length] == '!') {
        script_prepare(other, "material_set name=red base_color=1,0,0 face=0;"
                              "material_set name=blue base_color=0,0,1");
    }
    failing_resume();
    return other;
}

static void parse_value(const he_mesh *m, const he_param *param, const char *text, he_arg *arg,
                        uint32_t *ids, he_vec3 *points, he_mesh **other)
{
    double numbers[3 * MAX_LIST];
    arg->given = true;
    switch (param->type) {
    case HE_PARAM_ELEMENT:
        arg->id = parse_id(m, param->kind, &text);
        return;
    case HE_PARAM_ELEMENTS:
    case HE_PARAM_CYCLE:
        arg->ids = ids;
        arg->count = parse_ids(m, param->kind, text, ids);
        arg->list = arg->count > 1;
        return;
    case HE_PARAM_NUMBER:
        arg->number = strtod(text, NULL);
        return;
    case HE_PARAM_FLAG:
        arg->flag = *text == '1';
        return;
    case HE_PARAM_CHOICE:
        for (arg->choice = 0; strcmp(param->choices[arg->choice], text) != 0; arg->choice++) {
            assert_non_null(param->choices[arg->choice + 1]);
        }
        return;
    case HE_PARAM_POINT:
    case HE_PARAM_POINTS:
        arg->count = parse_numbers(text, numbers) / 3;
        arg->list = arg->count > 1;
        arg->points = points;
        for (size_t i = 0; i < arg->count; i++) {
            points[i] = (he_vec3){numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
        }
        return;
    case HE_PARAM_POLYGON:
        arg->count = parse_numbers(text, numbers) / 2;
        arg->points = points;
        for (size_t i = 0; i < arg->count; i++) {
            points[i] = (he_vec3){numbers[2 * i], numbers[2 * i + 1], 0};
        }
        return;
    case HE_PARAM_TEXT:
        arg->text = text;
        return;
    case HE_PARAM_COLOR:
        arg->count = parse_numbers(text, numbers);
        memcpy(arg->color, numbers, arg->count * sizeof *numbers);
        return;
    case HE_PARAM_MESH:
        arg->mesh = *other = other_mesh(text);
        return;
    case HE_PARAM_MATRIX:
        assert_int_equal(parse_numbers(text, numbers), 16);
        memcpy(arg->matrix, numbers, sizeof arg->matrix);
        return;
    }
}

static bool is_name(const char *name, const char *text, size_t length)
{
    return name != NULL && strlen(name) == length && memcmp(name, text, length) == 0;
}

const he_op *script_op(const char *operation)
{
    const he_op *op = he_op_find(operation, strcspn(operation, " "));
    if (op == NULL) {
        fail_msg("no operation: %s", operation);
    }
    return op;
}

he_status script_run(he_mesh *m, const char *operation, he_results *results, he_error *err)
{
    const he_op *op = script_op(operation);
    he_arg args[HE_OP_PARAMS];
    storage store;
    he_mesh *other = NULL;
    he_op_defaults(op, args);
    const char *at = operation + strcspn(operation, " ");
    while (*at == ' ') {
        at++;
        size_t name = strcspn(at, "="), value = strcspn(at, " ");
        size_t i = 0;
        while (!is_name(op->params[i].name, at, name) && !is_name(op->params[i].plural, at, name)) {
            i++;
            assert_true(i < he_op_params(op));
        }
        char *text = store.texts[i];
        assert_true(name < value && value - name <= MAX_TEXT);
        snprintf(text, MAX_TEXT, "%.*s", (int)(value - name - 1), at + name + 1);
        parse_value(m, &op->params[i], text, &args[i], store.ids[i], store.points[i], &other);
        at += value;
    }
    he_results own = {.each = false};
    he_status status = he_op_run(op, m, args, results != NULL ? results : &own, err);
    he_results_clear(&own);
    he_mesh_free(other);
    return status;
}

/* Sets a mark on elements, given as text: the name of the mark, then a kind of elements and their
 * ids, as in "locked vertices=1,2". */
static void mark(he_mesh *m, const char *text)
{
    char name[HE_COLUMN_NAME];
    size_t length = strcspn(text, " "), kind = 0, slot = 0;
    uint32_t ids[MAX_LIST];
    const unsigned char set = 1;
    snprintf(name, sizeof name, "%.*s", (int)length, text);
    text += length + 1;
    while (strncmp(text, he_kind_name((he_kind)kind), 4) != 0) {
        kind++;
        assert_true(kind < HE_KIND_COUNT);
    }
    he_column *column = NULL;
    if (he_mesh_find_column(m, (he_kind)kind, name) == NULL) {
        assert_int_equal(
            he_column_new(&(he_column_schema){name, (he_kind)kind, HE_BOOL, 1, HE_COPY}, &column,
                          NULL),
            HE_OK);
        assert_int_equal(he_column_extend(column, he_mesh_issued(m, (he_kind)kind), NULL), HE_OK);
        assert_int_equal(he_mesh_add_column(m, column, NULL), HE_OK);
    }
    while (he_mesh_column(m, slot) != he_mesh_find_column(m, (he_kind)kind, name)) {
        slot++;
    }
    size_t count = parse_ids(m, (he_kind)kind, text + strcspn(text, "=") + 1, ids);
    for (size_t i = 0; i < count; i++) {
        he_set_attribute(m, slot, ids[i], &set);
    }
}

/* Adds materials called m0, m1 and so on to the mesh's table of materials until the table has
 * `count` materials. */
static void fill_materials(he_mesh *m, size_t count)
{
    for (size_t i = he_mesh_materials(m)->count; i < count; i++) {
        char name[24];
        he_material *row = NULL;
        int length = snprintf(name, sizeof name, "m%zu", i);
        assert_int_equal(he_material_new(name, (size_t)length, &he_plain_look, &row, NULL), HE_OK);
        assert_int_equal(he_mesh_put_material(m, i, row, NULL), HE_OK);
    }
}

void script_prepare(he_mesh *m, const char *script)
{
    while (script != NULL && *script != '\0') {
        char text[MAX_TEXT];
        size_t length = strcspn(script, ";");
        assert_true(length < sizeof text);
        snprintf(text, sizeof text, "%.*s", (int)length, script);
        he_error err = {.status = HE_OK};
        if (strncmp(text, "mark ", 5) == 0) {
            mark(m, text + 5);
        } else if (strncmp(text, "materials ", 10) == 0) {
            fill_materials(m, (size_t)strtoul(text + 10, NULL, 10));
        } else if (script_run(m, text, NULL, &err) != HE_OK) {
            fail_msg("%s: %s", text, err.text);
        }
        script += length;
        script += strspn(script, "; ");
    }
}

/* --- assertions --- */

void assert_valid(const he_mesh *m)
{
    he_problem problem;
    size_t total = 0;
    assert_int_equal(he_check(m, &problem, 1, &total, NULL), HE_OK);
    if (total > 0) {
        fail_msg("I%d broken at %s %u: %s", problem.rule, he_kind_name(problem.kind), problem.id,
                 problem.text);
    }
}

void assert_counts(const he_mesh *m, uint32_t vertices, uint32_t edges, uint32_t faces)
{
    assert_int_equal(he_mesh_vertices(m), vertices);
    assert_int_equal(he_mesh_edges(m), edges);
    assert_int_equal(he_mesh_faces(m), faces);
    assert_valid(m);
}

void assert_face(const he_mesh *m, uint32_t f, const char *vertices)
{
    assert_true(he_mesh_is_live(m, HE_FACE, f));
    he_halfedge h = he_face_halfedge(m, (he_face){f});
    size_t n = strlen(vertices);
    assert_int_equal(he_loop_length(m, h), n);
    for (size_t turn = 0; turn < n && he_origin(m, h).i != digit(vertices[0]); turn++) {
        h = he_next(m, h);
    }
    for (size_t i = 0; i < n; i++, h = he_next(m, h)) {
        assert_int_equal(he_origin(m, h).i, digit(vertices[i]));
    }
}

void assert_equal(const he_mesh *m, const he_mesh *other)
{
    assert_true(he_mesh_equal(m, other));
}

void assert_loops(const he_mesh *m, const char *lengths)
{
    uint32_t halfedges = he_mesh_issued(m, HE_HALFEDGE);
    unsigned found[10] = {0};
    for (uint32_t i = 0; i < halfedges; i++) {
        he_halfedge h = {i};
        if (!he_mesh_is_live(m, HE_HALFEDGE, i) || !he_is_boundary_halfedge(m, h)) {
            continue;
        }
        /* Each boundary loop is counted only at the half-edge with the loop's lowest id. */
        he_halfedge k = he_next(m, h);
        while (k.i > i) {
            k = he_next(m, k);
        }
        if (k.i == i) {
            found[he_loop_length(m, h)]++;
        }
    }
    char text[64];
    size_t at = 0;
    for (unsigned length = 0; length < 10; length++) {
        for (unsigned i = 0; i < found[length]; i++) {
            text[at++] = (char)('0' + length);
        }
    }
    text[at] = '\0';
    assert_string_equal(text, lengths);
}

he_mesh *copy_of(const he_mesh *m)
{
    he_mesh *copy = NULL;
    assert_int_equal(he_mesh_copy(m, &copy, NULL), HE_OK);
    return copy;
}

void assert_ids(const he_ids *list, const char *expected)
{
    char text[256] = "";
    size_t at = 0;
    for (size_t i = 0; i < list->count; i++) {
        at += (size_t)snprintf(text + at, sizeof text - at, i == 0 ? "%u" : " %u", list->ids[i]);
    }
    assert_string_equal(text, expected);
}

int euler_of(const he_mesh *m)
{
    return (int)he_mesh_vertices(m) - (int)he_mesh_edges(m) + (int)he_mesh_faces(m);
}

double area_of(const he_mesh *m)
{
    he_measures measures;
    assert_int_equal(he_mesh_measure(m, &measures, NULL), HE_OK);
    return measures.area;
}
