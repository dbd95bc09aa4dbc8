#include "api/document/repairs.h"

/* The number of edges of the largest hole that the repair `fill` closes, unless the request sets
 * another limit. */
enum { HOLE_EDGES = 16 };

bool api_repairs_read(api_exchange *x, he_repair_plan *plan)
{
    *plan = (he_repair_plan){
        .which = api_param_choices(x, "repair"),
        .tolerance = api_param_number(x, "tolerance", 0),
        .hole_edges = api_param_u64(x, "hole_edges", HOLE_EDGES),
    };
    static const struct {
        const char *name;
        he_repair of;
    } needs[] = {{"tolerance", HE_REPAIR_WELD}, {"hole_edges", HE_REPAIR_FILL}};
    for (size_t i = 0; i < sizeof needs / sizeof *needs; i++) {
        if (api_param_text(x, needs[i].name) != NULL &&
            (plan->which & he_repair_bit(needs[i].of)) == 0) {
            return api_fail(x, API_BAD_PARAMETER,
                            "\"%s\" has no effect without repair=%s, which is not given",
                            needs[i].name, he_repair_names[needs[i].of]);
        }
    }
    return true;
}

enum { FIRST, SECOND };

static void write_ids(api_out *out, const char *key, const he_repair_account *account, int side)
{
    api_out_key(out, key);
    api_out_array_begin(out);
    for (size_t i = 0; i < account->named; i++) {
        api_out_id(out, side == FIRST ? account->pairs[i].a : account->pairs[i].b);
    }
    api_out_array_end(out);
}

/* Selects faces from the account of the repair drop_degenerate, which lists pairs of a face and the
 * number of faces that replaced it. If `gone` is true, selects the faces that nothing replaced,
 * else the faces that others replaced. */
static he_repair_account degenerate_ones(const he_repair_account *account, bool gone)
{
    he_repair_account some = {.count = 0};
    for (size_t i = 0; i < account->named; i++) {
        if ((account->pairs[i].b == 0) == gone) {
            some.pairs[some.named++] = account->pairs[i];
        }
    }
    return some;
}

static void write_parents(api_out *out, const he_repair_account *account)
{
    api_out_key(out, "parents");
    api_out_object_begin(out);
    api_out_key(out, "vertices");
    api_out_array_begin(out);
    for (size_t i = 0; i < account->named; i++) {
        api_out_array_begin(out);
        api_out_id(out, account->pairs[i].a);
        api_out_id(out, account->pairs[i].b);
        api_out_array_end(out);
    }
    api_out_array_end(out);
    api_out_object_end(out);
}

/* Writes the lines or byte offsets in the input of the elements that a repair removed. */
static void write_source_map(api_out *out, const he_repair_account *account,
                             const he_source_map *map)
{
    if (map == NULL || map->unit == HE_PLACE_NONE || map->count == 0) {
        return;
    }
    api_out_key(out, map->unit == HE_PLACE_LINE ? "lines" : "bytes");
    api_out_array_begin(out);
    for (size_t i = 0; i < account->named; i++) {
        api_out_u64(out, he_source_map_find(map, account->pairs[i].a));
    }
    api_out_array_end(out);
}

static void write_clashes(api_out *out, const he_repaired *done)
{
    uint64_t total = done->accounts[HE_REPAIR_ORIENT].left;
    api_out_key_u64(out, "not_orientable", total);
    if (total == 0) {
        return;
    }
    api_out_key(out, "clashes");
    api_out_array_begin(out);
    for (size_t i = 0; i < total && i < HE_REPAIR_NAMED; i++) {
        api_out_id(out, done->clashes[i].face);
    }
    api_out_array_end(out);
}

static void write_one(api_out *out, he_repair repair, const he_repair_plan *plan,
                      const he_repaired *done, const he_import *import)
{
    const he_repair_account *account = &done->accounts[repair];
    api_out_object_begin(out);
    api_out_key_string(out, "repair", he_repair_names[repair]);
    api_out_key_u64(out, "count", account->count);
    switch (repair) {
    case HE_REPAIR_WELD:
        api_out_key_number(out, "tolerance", plan->tolerance);
        write_ids(out, "gone", account, FIRST);
        write_ids(out, "into", account, SECOND);
        write_source_map(out, account, import == NULL ? NULL : &import->vertices);
        api_out_key_u64(out, "moved", account->moved);
        break;
    case HE_REPAIR_DROP_DEGENERATE: {
        he_repair_account gone = degenerate_ones(account, true);
        he_repair_account mended = degenerate_ones(account, false);
        write_ids(out, "gone", &gone, FIRST);
        write_source_map(out, &gone, import == NULL ? NULL : &import->faces);
        api_out_key_u64(out, "mended", account->parts);
        write_ids(out, "faces", &mended, FIRST);
        break;
    }
    case HE_REPAIR_DROP_DUPLICATES:
        write_ids(out, "gone", account, FIRST);
        write_ids(out, "into", account, SECOND);
        write_source_map(out, account, import == NULL ? NULL : &import->faces);
        break;
    case HE_REPAIR_ORIENT:
        api_out_key_u64(out, "components", account->parts);
        write_ids(out, "faces", account, FIRST);
        write_clashes(out, done);
        break;
    case HE_REPAIR_SPLIT:
        api_out_key_u64(out, "vertices", account->parts);
        write_parents(out, account);
        break;
    case HE_REPAIR_FILL:
        api_out_key_u64(out, "hole_edges", plan->hole_edges);
        write_ids(out, "faces", account, FIRST);
        api_out_key_u64(out, "left", account->left);
        break;
    case HE_REPAIR_COUNT:
        break;
    }
    api_out_object_end(out);
}

void api_repairs_write(api_out *out, const he_repair_plan *plan, const he_repaired *done,
                       const he_import *import)
{
    api_out_array_begin(out);
    for (he_repair repair = HE_REPAIR_WELD; repair < HE_REPAIR_COUNT; repair++) {
        if ((plan->which & he_repair_bit(repair)) != 0) {
            write_one(out, repair, plan, done, import);
        }
    }
    api_out_array_end(out);
}
