#include "format/gltf/gltf_material.h"

#include <stdio.h>
#include <string.h>

/* --- names --- */

/* Adds the name of material i to `names`, with a number if an earlier material has the same name.
 */
static he_status add_name(he_gltf *asset, size_t i, he_labels *names, char name[HE_GLTF_NAME],
                          he_error *err)
{
    enum { FEW = 64 };
    const he_json *json = &asset->json;
    uint32_t value = asset->materials.ids[i], index = 0;
    char own[HE_GLTF_NAME];
    size_t length = he_json_string(json, he_json_find(json, value, "name"), own, sizeof own);
    if (length == 0) {
        snprintf(own, sizeof own, "material_%zu", i);
    }
    memcpy(name, own, strlen(own) + 1);
    for (unsigned number = 2; he_labels_find(names, name, strlen(name), &index); number++) {
        if (number == 2) {
            he_gltf_note_text(asset, "material_renamed",
                              "material % is renamed by adding a number, because an earlier "
                              "material has its name",
                              own, value);
        }
        /* After a few tries the next number is i + 1, which in most files no name has. */
        number = number > FEW && number <= i ? (unsigned)i + 1 : number;
        he_material_number_name(own, number, name);
    }
    return he_labels_add(names, name, strlen(name), &index, err);
}

/* --- numbers --- */

typedef struct reading {
    he_gltf *asset;
    bool odd; /* true if some number of the material was not valid */
} reading;

static void read_number(reading *r, uint32_t object, const char *name, double *out)
{
    uint32_t value = he_json_find(&r->asset->json, object, name);
    double number = 0;
    if (value == HE_NONE) {
        return;
    }
    if (he_json_number(&r->asset->json, value, &number, NULL) == HE_OK) {
        *out = number;
    } else {
        r->odd = true;
    }
}

static void read_numbers(reading *r, uint32_t object, const char *name, size_t count, double *out)
{
    const he_json *json = &r->asset->json;
    uint32_t list = he_json_find(json, object, name), item = he_json_first(json, list);
    double numbers[4];
    size_t n = 0;
    if (list == HE_NONE) {
        return;
    }
    for (; item != HE_NONE && n < count; item = he_json_after(json, list, item)) {
        if (he_json_number(json, item, &numbers[n], NULL) != HE_OK) {
            break;
        }
        n++;
    }
    if (n < count || item != HE_NONE || he_json_type(json, list) != '[') {
        r->odd = true;
    } else {
        memcpy(out, numbers, count * sizeof *out);
    }
}

static void read_opacity(reading *r, uint32_t value, he_look *look)
{
    const he_json *json = &r->asset->json;
    uint32_t mode = he_json_find(json, value, "alphaMode");
    char name[HE_GLTF_NAME];
    he_json_string(json, he_json_find(json, value, "name"), name, sizeof name);
    if (mode == HE_NONE || he_json_is(json, mode, "OPAQUE")) {
        if (look->base_color[3] < 1) {
            he_gltf_note_text(
                r->asset, "opaque",
                "the opacity of material % is set to 1, because its alphaMode is OPAQUE", name,
                value);
        }
        look->base_color[3] = 1;
    } else if (he_json_is(json, mode, "MASK")) {
        he_gltf_note_text(
            r->asset, "ignored_mask",
            "the alphaCutoff of material % is ignored, because the materials of a mesh have none",
            name, value);
    }
}

static he_look read_look(reading *r, uint32_t value)
{
    const he_json *json = &r->asset->json;
    he_look look = {.base_color = {1, 1, 1, 1}, .metallic = 1, .roughness = 1};
    uint32_t factors = he_json_find(json, value, "pbrMetallicRoughness");
    uint32_t extensions = he_json_find(json, value, "extensions");
    uint32_t glossy = he_json_find(json, extensions, "KHR_materials_pbrSpecularGlossiness");
    uint32_t strong = he_json_find(json, extensions, HE_GLTF_EMISSIVE_STRENGTH);
    double strength = 1;
    if (factors == HE_NONE && glossy != HE_NONE) {
        double glossiness = 1;
        read_numbers(r, glossy, "diffuseFactor", 4, look.base_color);
        read_number(r, glossy, "glossinessFactor", &glossiness);
        look.metallic = 0;
        look.roughness = 1 - glossiness;
    }
    read_numbers(r, factors, "baseColorFactor", 4, look.base_color);
    read_number(r, factors, "metallicFactor", &look.metallic);
    read_number(r, factors, "roughnessFactor", &look.roughness);
    read_numbers(r, value, "emissiveFactor", 3, look.emission);
    read_number(r, strong, "emissiveStrength", &strength);
    for (size_t i = 0; i < 3; i++) {
        look.emission[i] *= strength;
    }
    look.two_sided = he_json_type(json, he_json_find(json, value, "doubleSided")) == 't';
    read_opacity(r, value, &look);
    return look;
}

/* --- rows --- */

static he_status add_row(he_gltf *asset, uint32_t value, const char *name, he_error *err)
{
    he_materials *table = &asset->into->soup.materials;
    const he_json *json = &asset->json;
    reading r = {.asset = asset};
    he_material *row = NULL;
    uint32_t own = he_json_find(json, he_json_find(json, value, "extras"), "hedge");
    if (he_json_is(json, own, "name")) {
        return HE_OK; /* hedge wrote this material for its name alone: the table gets no row */
    }
    if (table->count == HE_MATERIALS) {
        he_gltf_note(asset, "material_limit",
                     "a material is left out, because a mesh has at most 4096 materials", HE_NONE,
                     value);
        return HE_OK;
    }
    he_look look = read_look(&r, value);
    r.odd |= he_look_clamp(&look);
    if (r.odd) {
        he_gltf_note_text(asset, "material_range",
                          "an invalid number of material % is replaced by its default or the "
                          "nearest allowed value",
                          name, value);
    }
    he_status status = he_material_new(name, strlen(name), &look, &row, err);
    if (status == HE_BAD_VALUE) { /* the name has a control character: the material is left out */
        he_gltf_note_text(asset, "material_name",
                          "material % is left out, because its name has a control character", name,
                          value);
        return HE_OK;
    }
    if (status == HE_OK) {
        status = he_materials_add(table, row, err);
    }
    if (status != HE_OK) {
        he_material_release(row);
    }
    return status;
}

he_status he_gltf_read_materials(he_gltf *asset, he_labels **out, he_error *err)
{
    he_labels *names = he_labels_new();
    he_status status =
        names == NULL ? he_fail_plain(err, HE_NO_MEMORY, "no memory for the names of materials")
                      : HE_OK;
    for (size_t i = 0; i < asset->materials.count && status == HE_OK; i++) {
        char name[HE_GLTF_NAME];
        uint32_t value = asset->materials.ids[i];
        status = he_gltf_spend(asset, value, 8 * he_json_span(&asset->json, value), err);
        if (status == HE_OK) {
            status = he_gltf_poll(asset, err);
        }
        if (status == HE_OK) {
            status = add_name(asset, i, names, name, err);
        }
        if (status == HE_OK) {
            status = add_row(asset, value, name, err);
        }
    }
    if (status != HE_OK) {
        he_labels_release(names);
        return status;
    }
    *out = names;
    return HE_OK;
}
