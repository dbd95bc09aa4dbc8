/* edit_read.c - reads a stored edit into a delta and applies the delta to a mesh. */
#include "mesh/content.h"
#include "stored/attribute_code.h"
#include "stored/edit_code.h"
#include "stored/stored.h"

static const he_col columns[] = {
    [HE_CODE_NEXT] = HE_COL_NEXT,
    [HE_CODE_PREV] = HE_COL_PREV,
    [HE_CODE_ORIGIN] = HE_COL_ORIGIN,
    [HE_CODE_FACE] = HE_COL_FACE,
    [HE_CODE_VERTEX_HALFEDGE] = HE_COL_VERTEX_HALFEDGE,
    [HE_CODE_FACE_HALFEDGE] = HE_COL_FACE_HALFEDGE,
    [HE_CODE_POSITION] = HE_COL_POSITION,
    [HE_CODE_PARENT] = HE_COL_PARENT,
    [HE_CODE_MERGED] = HE_COL_MERGED,
    [HE_CODE_ATTRIBUTE] = HE_COL_ATTRIBUTE,
};

/* A record names an attribute by 24 bits of its member `column`. So it can name this many slots. */
enum { MOST_SLOTS = (1 << 24) - HE_COL_ATTRIBUTE };

typedef struct edit_reader {
    he_cursor c;
    unsigned version;
    uint64_t changes; /* number of changes that are not read yet */
    /* code (kind of change) of the current run, which is a sequence of changes to one column */
    he_code code;
    uint64_t run;                 /* number of changes in the current run that are not read yet */
    uint32_t slot;                /* slot of the attribute that the current run changes */
    uint32_t last[HE_CODE_COUNT]; /* for each code, the row of the last change with this code */
    /* kind of the object (attribute, material or mesh data) of the current change */
    he_object kind;
    he_cursor object; /* bytes of the object of the current change */
} edit_reader;

static he_status begin(edit_reader *r, const unsigned char *bytes, size_t size, he_error *err)
{
    *r = (edit_reader){.c = he_cursor_over(bytes, size)};
    unsigned char version;
    if (!he_take_bytes(&r->c, 1, &version)) {
        return he_refuse_at(&r->c, err, "the stored edit is empty");
    }
    if (version == 0 || version > HE_EDIT_VERSION) {
        return he_fail_at(err, version > HE_EDIT_VERSION ? HE_UNSUPPORTED : HE_CORRUPT,
                          HE_PLACE_BYTE, 0,
                          "the stored edit has version %u, but this release reads up to version %u",
                          version, (unsigned)HE_EDIT_VERSION);
    }
    r->version = version;
    if (!he_take_varint(&r->c, he_left(&r->c) / HE_CHANGE_LEAST, &r->changes)) {
        return he_refuse_at(&r->c, err,
                            "the stored edit declares more changes than its bytes can hold");
    }
    return HE_OK;
}

static he_status begin_object(edit_reader *r, he_error *err)
{
    unsigned char kind;
    uint64_t length;
    if (!he_take_bytes(&r->c, 1, &kind) || !he_take_u64(&r->c, &length) ||
        length > he_left(&r->c)) {
        return he_refuse_at(
            &r->c, err,
            "a stored attribute, content or material, or stored positions, run past the end of the "
            "edit");
    }
    const unsigned last = r->version < 2 ? HE_OBJECT_MATERIAL : HE_OBJECT_POSITIONS;
    if (kind < HE_OBJECT_ADDED || kind > last) {
        return he_refuse_at(&r->c, err, "the stored edit holds an object of an unknown kind");
    }
    r->kind = (he_object)kind;
    r->object = r->c;
    r->c.at += length;
    r->object.end = r->c.at;
    return HE_OK;
}

static he_status begin_run(edit_reader *r, he_error *err)
{
    uint64_t tag, slot;
    if (!he_take_varint(&r->c, UINT64_MAX, &tag)) {
        return he_refuse_at(&r->c, err, "the stored edit ends before its last change");
    }
    if (tag % 16 >= HE_CODE_COUNT || tag / 16 >= r->changes) {
        return he_refuse_at(
            &r->c, err,
            "the stored edit holds a change of an unknown kind, or more changes than it declares");
    }
    r->code = (he_code)(tag % 16);
    r->run = tag / 16 + 1;
    if (r->code == HE_CODE_ATTRIBUTE) {
        if (!he_take_varint(&r->c, MOST_SLOTS - 1, &slot)) {
            return he_refuse_at(&r->c, err, "the slot number of an attribute is out of range");
        }
        r->slot = (uint32_t)slot;
    }
    if (r->code == HE_CODE_OBJECT && r->run > 1) {
        return he_refuse_at(
            &r->c, err,
            "attributes, contents and materials must each be stored as a change of their own");
    }
    return r->code == HE_CODE_OBJECT ? begin_object(r, err) : HE_OK;
}

static bool take_lineage(edit_reader *r, he_record *out)
{
    unsigned char kind;
    uint32_t other;
    if (!he_take_bytes(&r->c, 1, &kind) || kind >= HE_CODE_KINDS ||
        !he_take_difference(&r->c, out->row, &other)) {
        return false;
    }
    out->word = he_code_kinds[kind];
    out->before = other;
    return true;
}

static bool take_values(edit_reader *r, he_record *out)
{
    unsigned char word;
    uint32_t before, after;
    if (!he_take_bytes(&r->c, 1, &word) || !he_take_u32(&r->c, &before) ||
        !he_take_u32(&r->c, &after)) {
        return false;
    }
    out->word = word;
    out->before = before;
    out->after = after;
    return true;
}

static bool take_links(edit_reader *r, he_record *out)
{
    uint32_t before, after;
    if (!he_take_link(&r->c, out->row, &before) || !he_take_link(&r->c, out->row, &after)) {
        return false;
    }
    out->before = before;
    out->after = after;
    return true;
}

/* Reads the next change of the edit. If the change has an object (an attribute, a material or mesh
 * data), only finds its bytes. */
static he_status next(edit_reader *r, he_record *out, he_error *err)
{
    if (r->run == 0) {
        he_status status = begin_run(r, err);
        if (status != HE_OK) {
            return status;
        }
    }
    r->run--;
    r->changes--;
    *out = (he_record){0};
    if (r->code == HE_CODE_OBJECT) {
        return HE_OK;
    }
    uint32_t row;
    bool taken = he_take_difference(&r->c, r->last[r->code], &row);
    if (taken) {
        out->row = r->last[r->code] = row;
        bool lineage = r->code == HE_CODE_PARENT || r->code == HE_CODE_MERGED;
        bool values = r->code == HE_CODE_POSITION || r->code == HE_CODE_ATTRIBUTE;
        uint32_t column = (uint32_t)columns[r->code] + (r->code == HE_CODE_ATTRIBUTE ? r->slot : 0);
        out->column = column & 0xFFFFFFu;
        taken = lineage ? take_lineage(r, out) : values ? take_values(r, out) : take_links(r, out);
    }
    return taken ? HE_OK
                 : he_refuse_at(&r->c, err,
                                "a stored change is cut short, or holds an impossible link");
}

static he_status take_slot(he_cursor *c, uint32_t *slot, he_error *err)
{
    uint64_t value;
    if (!he_take_varint(c, MOST_SLOTS - 1, &value)) {
        return he_refuse_at(c, err, "the slot number of an attribute is out of range");
    }
    *slot = (uint32_t)value;
    return HE_OK;
}

/* Reads the values of a column for all elements, up to the end of the bytes. */
static he_status take_rows(he_cursor *c, he_column *column, he_error *err)
{
    uint64_t rows;
    if (!he_take_varint(c, 2 * (uint64_t)HE_MAX_ROWS, &rows) ||
        rows * column->row_bytes != he_left(c)) {
        return he_refuse_at(c, err,
                            "a stored attribute does not have as many values as it declares");
    }
    he_status status = he_column_reserve(column, (size_t)rows, err);
    if (status == HE_OK) {
        (void)he_take_bytes(c, he_left(c), column->data);
        column->rows = (size_t)rows;
    }
    return status;
}

static he_status take_added(he_cursor *c, uint32_t *slot, he_column **out, he_error *err)
{
    he_column *column = NULL;
    he_status status = take_slot(c, slot, err);
    if (status == HE_OK) {
        status = he_head_take(c, &column, err);
    }
    if (status == HE_OK) {
        status = he_labels_take(c, &column->labels, err);
    }
    if (status == HE_OK) {
        status = take_rows(c, column, err);
    }
    if (status != HE_OK) {
        he_column_free(column);
        return status;
    }
    *out = column;
    return HE_OK;
}

/* Reads positions of the first vertices, up to the end of the bytes; *count is their number. */
static he_status take_positions(he_cursor *c, uint32_t *count, he_column **out, he_error *err)
{
    he_column *column = NULL;
    he_status status = he_column_new(&he_position_schema, &column, err);
    if (status == HE_OK) {
        status = take_rows(c, column, err);
    }
    if (status != HE_OK) {
        he_column_free(column);
        return status;
    }
    *count = (uint32_t)column->rows;
    *out = column;
    return HE_OK;
}

static bool same_head(const he_column *a, const he_column *b)
{
    return strcmp(a->name, b->name) == 0 && a->domain == b->domain && a->type == b->type &&
           a->rule == b->rule && a->components == b->components &&
           memcmp(a->fallback, b->fallback, a->row_bytes) == 0;
}

/* Reads the record of an attribute that the edit removed. Checks that the mesh has this attribute,
 * unless the edit itself has already added or removed an attribute in this slot. `named` has a bit
 * for each slot of the mesh, which is set if the edit has done so. */
static he_status take_dropped(he_cursor *c, const he_mesh *mesh, const uint64_t *named,
                              uint32_t *slot, he_error *err)
{
    he_column *column = NULL;
    he_status status = take_slot(c, slot, err);
    if (status == HE_OK) {
        status = he_head_take(c, &column, err);
    }
    if (status == HE_OK && he_left(c) > 0) {
        status = he_refuse_at(c, err, "extra bytes follow a stored attribute or material");
    }
    if (status == HE_OK && *slot < he_mesh_columns(mesh) && !he_bits_get(named, *slot)) {
        const he_column *there = he_mesh_column(mesh, *slot);
        if (there == NULL || !same_head(there, column)) {
            status = he_refuse_at(
                c, err, "the mesh does not have the attribute that the stored edit removes");
        }
    }
    he_column_free(column);
    return status;
}

static he_status take_replaced(he_cursor *c, he_record *out, he_content **content, he_error *err)
{
    unsigned char renumbers;
    he_mesh *mesh;
    if (!he_take_bytes(c, 1, &renumbers) || renumbers > 1) {
        return he_refuse_at(c, err,
                            "a stored replacement must say 0 (ids stay) or 1 (ids are new)");
    }
    he_content *taken = he_mem_alloc(sizeof *taken);
    he_status status =
        taken == NULL ? he_fail_plain(err, HE_NO_MEMORY, "no memory for the content after an edit")
                      : he_stored_content_read(c->at, he_left(c), &mesh, err);
    if (status != HE_OK) {
        he_mem_free(taken);
        return status;
    }
    *taken = mesh->c;
    mesh->c = (he_content){0};
    he_mesh_free(mesh);
    *content = taken;
    out->row = renumbers;
    return HE_OK;
}

/* Reads the record of a material that the edit put into a slot. The material that was in the slot
 * before is identified by its mark (material.h), which is stored in out->after. */
static he_status take_put_material(he_cursor *c, he_record *out, uint32_t *slot, he_material **row,
                                   he_error *err)
{
    uint64_t value;
    uint32_t mark;
    if (!he_take_varint(c, HE_MATERIALS - 1, &value) || !he_take_u32(c, &mark)) {
        return he_refuse_at(c, err, "the slot number of a material is out of range");
    }
    he_status status = he_left(c) > 0 ? he_material_take(c, row, err) : HE_OK;
    if (status == HE_OK && he_left(c) > 0) {
        he_material_release(*row);
        *row = NULL;
        return he_refuse_at(c, err, "extra bytes follow a stored attribute or material");
    }
    *slot = (uint32_t)value;
    out->after = mark;
    return status;
}

/* Reads the object of the current change (an attribute, a material, positions or mesh data) and
 * appends it to the objects of the delta. */
static he_status take_object(edit_reader *r, const he_mesh *mesh, uint64_t *named, he_delta *delta,
                             he_record *out, he_error *err)
{
    he_column *column = NULL;
    he_content *content = NULL;
    he_material *material = NULL;
    uint32_t slot = 0;
    he_status status = he_delta_reserve(delta, 0, 1, err);
    if (status != HE_OK) {
        return status;
    }
    switch (r->kind) {
    case HE_OBJECT_ADDED:
        out->column = HE_COL_COLUMN_ADDED;
        status = take_added(&r->object, &slot, &column, err);
        break;
    case HE_OBJECT_DROPPED:
        out->column = HE_COL_COLUMN_DROPPED;
        status = take_dropped(&r->object, mesh, named, &slot, err);
        break;
    case HE_OBJECT_REPLACED:
        out->column = HE_COL_REPLACED;
        status =
            delta->count > 0 || r->changes > 0
                ? he_refuse_at(&r->object, err,
                               "a stored edit that replaces the content must hold no other change")
                : take_replaced(&r->object, out, &content, err);
        break;
    case HE_OBJECT_MATERIAL:
        out->column = HE_COL_MATERIAL;
        status = take_put_material(&r->object, out, &slot, &material, err);
        break;
    case HE_OBJECT_POSITIONS:
        out->column = HE_COL_POSITIONS;
        status = take_positions(&r->object, &slot, &column, err);
        break;
    }
    if (status != HE_OK) {
        return status;
    }
    if (r->kind != HE_OBJECT_REPLACED) {
        out->row = slot;
    }
    if ((r->kind == HE_OBJECT_ADDED || r->kind == HE_OBJECT_DROPPED) &&
        slot < he_mesh_columns(mesh)) {
        he_bits_set(named, slot);
    }
    out->before = (uint32_t)delta->object_count;
    delta->objects[delta->object_count++] = content != NULL    ? (void *)content
                                            : material != NULL ? (void *)material
                                                               : (void *)column;
    return HE_OK;
}

static he_status take_changes(edit_reader *r, const he_mesh *mesh, he_delta *delta, he_error *err)
{
    uint64_t *named = he_bits_new(he_mesh_columns(mesh));
    he_status status = named == NULL ? he_fail_plain(err, HE_NO_MEMORY, "no memory to read an edit")
                                     : he_delta_reserve(delta, (size_t)r->changes, 0, err);
    while (status == HE_OK && r->changes > 0) {
        he_record record;
        status = next(r, &record, err);
        if (status == HE_OK && r->code == HE_CODE_OBJECT) {
            status = take_object(r, mesh, named, delta, &record, err);
        }
        if (status == HE_OK) {
            delta->records[delta->count++] = record;
        }
    }
    if (status == HE_OK && he_left(&r->c) > 0) {
        status = he_refuse_at(&r->c, err, "extra bytes follow the last change of the stored edit");
    }
    he_mem_free(named);
    return status;
}

/* Returns true if an added attribute has no more values than the mesh has elements of its domain
 * after the edit. */
static bool fits(const he_column *column, const uint32_t issued[HE_KIND_COUNT])
{
    switch (column->domain) {
    case HE_VERTEX:
    case HE_EDGE:
    case HE_FACE:
        return column->rows <= issued[column->domain];
    case HE_HALFEDGE:
        return column->rows <= 2 * (size_t)issued[HE_EDGE];
    case HE_MESH_KIND:
    case HE_KIND_COUNT:
        break;
    }
    return column->rows <= 1;
}

/* Checks `issued`, which states for each kind of element how many ids are issued after the edit. If
 * the edit replaces all mesh data, these must be the numbers of the new data. Otherwise each may be
 * larger than before by no more than the number of changes. */
static he_status check_marks(const he_delta *delta, const he_mesh *mesh,
                             const uint32_t issued[HE_KIND_COUNT], he_error *err)
{
    static const he_kind tables[] = {HE_VERTEX, HE_EDGE, HE_FACE};
    bool whole = delta->count > 0 && delta->records[0].column == HE_COL_REPLACED;
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        uint32_t mark = issued[tables[i]], now = he_mesh_issued(mesh, tables[i]);
        bool good = whole ? mark == he_content_issued(delta->objects[0], tables[i])
                          : mark >= now && mark - now <= delta->count && mark <= HE_MAX_ROWS;
        if (!good) {
            return he_fail_at(err, HE_CORRUPT, HE_PLACE_BYTE, 0,
                              "a stored edit of %zu changes cannot give out ids of %s up to %u",
                              delta->count, he_kind_plural(tables[i]), mark);
        }
    }
    for (size_t i = 0; i < delta->count && delta->object_count > 0; i++) {
        const he_record *r = &delta->records[i];
        const bool rows = r->column == HE_COL_COLUMN_ADDED || r->column == HE_COL_POSITIONS;
        if (rows && !fits(delta->objects[r->before], issued)) {
            return he_fail_at(err, HE_CORRUPT, HE_PLACE_BYTE, 0,
                              "the attribute or the positions that change %zu puts into the mesh "
                              "have more values than the mesh has elements",
                              i);
        }
    }
    return HE_OK;
}

/* Returns the index of the byte at which a change begins in a stored edit, which was read before
 * without an error. */
static uint64_t place_of(const unsigned char *bytes, size_t size, size_t change)
{
    edit_reader r;
    he_record record;
    he_status status = begin(&r, bytes, size, NULL);
    for (size_t i = 0; i < change && status == HE_OK; i++) {
        status = next(&r, &record, NULL);
    }
    return (uint64_t)(r.c.at - bytes);
}

he_status he_stored_edit_forward(const unsigned char *bytes, size_t size,
                                 const uint32_t issued[HE_KIND_COUNT], he_mesh *mesh,
                                 he_delta **out, he_error *err)
{
    edit_reader r;
    size_t refused = SIZE_MAX;
    he_status status = begin(&r, bytes, size, err);
    if (status != HE_OK) {
        return status;
    }
    he_delta *delta = he_delta_new();
    status = delta == NULL ? he_fail_plain(err, HE_NO_MEMORY, "no memory to read an edit")
                           : take_changes(&r, mesh, delta, err);
    if (status == HE_OK) {
        status = check_marks(delta, mesh, issued, err);
    }
    if (status == HE_OK) {
        status = he_delta_forward(delta, mesh, issued, &refused, err);
    }
    if (status != HE_OK) {
        if (refused != SIZE_MAX && err != NULL) {
            err->place = HE_PLACE_BYTE;
            err->at = place_of(bytes, size, refused);
        }
        he_delta_free(delta);
        return status;
    }
    he_delta_trim(delta);
    *out = delta;
    return HE_OK;
}
