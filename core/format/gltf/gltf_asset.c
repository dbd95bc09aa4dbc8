#include "format/gltf/gltf_asset.h"

#include <string.h>

void he_gltf_note(he_gltf *asset, const char *code, const char *text, uint32_t subject,
                  uint32_t place)
{
    char name[HE_WARNING_SUBJECT];
    size_t length =
        subject == HE_NONE ? 0 : he_json_string(&asset->json, subject, name, sizeof name);
    he_warnings_add(&asset->into->warnings,
                    &(he_occurrence){.code = code,
                                     .text = text,
                                     .subject = subject == HE_NONE ? NULL : name,
                                     .length = length,
                                     .place = HE_PLACE_BYTE,
                                     .at = he_json_place(&asset->json, place)});
}

void he_gltf_note_text(he_gltf *asset, const char *code, const char *text, const char *subject,
                       uint32_t place)
{
    he_warnings_add(&asset->into->warnings,
                    &(he_occurrence){.code = code,
                                     .text = text,
                                     .subject = subject,
                                     .length = strlen(subject),
                                     .place = HE_PLACE_BYTE,
                                     .at = he_json_place(&asset->json, place)});
}

void he_gltf_note_stale(he_gltf *asset, uint32_t place)
{
    he_gltf_note(asset, "stale_extras",
                 "data that hedge stored in extras of the file is ignored, because it does not fit "
                 "the geometry",
                 HE_NONE, place);
}

/* Reports progress. The number of steps that reading will take is not known, so the fraction
 * that is reported only approaches 1: it is one half when a step was made for each 16 bytes of
 * the file. Few files take fewer steps than that. */
he_status he_gltf_tell(he_gltf *asset, he_error *err)
{
    asset->told = asset->steps;
    return he_progress_step(asset->into->soup.limits.progress, asset->steps,
                            asset->steps + asset->size / 16, err);
}

he_status he_gltf_spend(he_gltf *asset, uint32_t value, uint64_t bytes, he_error *err)
{
    if (bytes > asset->room) {
        return he_json_fail(&asset->json, value, err, HE_LIMIT,
                            "the scene has more than %llu MiB of geometry, and more than %llu "
                            "times the size of the file",
                            (unsigned long long)(HE_GLTF_ROOM >> 20),
                            (unsigned long long)HE_GLTF_FACTOR);
    }
    asset->room -= bytes;
    return HE_OK;
}

he_status he_gltf_item(he_gltf *asset, const he_ids *list, uint32_t value, const char *what,
                       uint32_t *item, he_error *err)
{
    uint64_t index = 0;
    he_status status = he_json_whole(&asset->json, value, 0, HE_JSON_WHOLE, &index, err);
    if (status != HE_OK) {
        return status;
    }
    if (index >= list->count) {
        return he_json_fail(&asset->json, value, err, HE_BAD_INDEX,
                            "there is no %s %llu; the file has %zu", what,
                            (unsigned long long)index, list->count);
    }
    *item = list->ids[index];
    /* The caller visits all members of the item, so memory for each is charged to the asset's
     * limit. */
    return he_gltf_spend(asset, value, 8 * he_json_span(&asset->json, *item), err);
}

he_status he_gltf_need(const he_gltf *asset, uint32_t object, const char *name, he_gltf_range range,
                       uint64_t *out, he_error *err)
{
    uint32_t value = he_json_find(&asset->json, object, name);
    if (value == HE_NONE) {
        return he_json_fail(&asset->json, object, err, HE_BAD_VALUE, "'%s' is missing", name);
    }
    return he_json_whole(&asset->json, value, range.least, range.most, out, err);
}

he_status he_gltf_may(const he_gltf *asset, uint32_t object, const char *name, uint64_t most,
                      uint64_t *out, he_error *err)
{
    uint32_t value = he_json_find(&asset->json, object, name);
    *out = 0;
    return value == HE_NONE ? HE_OK : he_json_whole(&asset->json, value, 0, most, out, err);
}

he_status he_gltf_array(const he_gltf *asset, uint32_t object, const char *name, uint32_t *out,
                        he_error *err)
{
    *out = he_json_find(&asset->json, object, name);
    if (*out != HE_NONE && he_json_type(&asset->json, *out) != '[') {
        return he_json_fail(&asset->json, *out, err, HE_BAD_VALUE, "the value is not an array");
    }
    return HE_OK;
}

/* --- the whole --- */

he_status he_gltf_list(he_gltf *asset, const char *name, he_ids *list, he_error *err)
{
    const he_json *json = &asset->json;
    uint32_t array = HE_NONE;
    he_status status = he_gltf_array(asset, 0, name, &array, err);
    if (status != HE_OK) {
        return status;
    }
    for (uint32_t i = he_json_first(json, array); i != HE_NONE && status == HE_OK;
         i = he_json_after(json, array, i)) {
        if (he_json_type(json, i) != '{') {
            return he_json_fail(json, i, err, HE_BAD_VALUE, "the value is not an object");
        }
        status = he_ids_add(list, i, err);
    }
    return status;
}

static he_status check_version(const he_gltf *asset, he_error *err)
{
    const he_json *json = &asset->json;
    uint32_t object = he_json_find(json, 0, "asset");
    uint32_t version = he_json_find(json, object, "version");
    uint32_t least = he_json_find(json, object, "minVersion");
    char text[24];
    if (he_json_type(json, 0) != '{' || he_json_type(json, version) != '"') {
        return he_json_fail(json, object, err, HE_SYNTAX,
                            "not a glTF asset: 'asset' has no 'version'");
    }
    he_json_string(json, version, text, sizeof text);
    if (text[0] != '2' || (text[1] != '.' && text[1] != '\0')) {
        return he_json_fail(json, version, err, HE_UNSUPPORTED, "the version of glTF is not 2");
    }
    if (least != HE_NONE && !he_json_is(json, least, "2.0")) {
        return he_json_fail(json, least, err, HE_UNSUPPORTED,
                            "the file needs a reader of a later version than glTF 2.0");
    }
    return HE_OK;
}

static bool begins_with_any(const he_json *json, uint32_t name, const char *const *list)
{
    for (; *list != NULL; list++) {
        if (he_json_begins(json, name, *list)) {
            return true;
        }
    }
    return false;
}

static he_status check_extensions(he_gltf *asset, he_error *err)
{
    /* The prefixes of extensions that change how a surface looks, not its geometry: they may be
     * ignored even if the asset requires them. */
    static const char *const looks[] = {"KHR_materials_",
                                        "KHR_texture_",
                                        "EXT_texture_",
                                        "MSFT_texture_",
                                        "KHR_lights_",
                                        "EXT_lights_",
                                        "KHR_xmp",
                                        "KHR_animation",
                                        "KHR_techniques_webgl",
                                        "AGI_articulations",
                                        NULL};
    const he_json *json = &asset->json;
    uint32_t list = he_json_find(json, 0, "extensionsRequired");
    for (uint32_t i = he_json_first(json, list); i != HE_NONE; i = he_json_after(json, list, i)) {
        char name[HE_WARNING_SUBJECT], quoted[HE_WARNING_SUBJECT];
        size_t length = he_json_string(json, i, name, sizeof name);
        bool quantized = he_json_is(json, i, "KHR_mesh_quantization");
        bool packed = he_json_is(json, i, HE_GLTF_MESHOPT);
        asset->quantized |= quantized;
        if (he_json_is(json, i, "KHR_draco_mesh_compression")) {
            return he_json_fail(json, i, err, HE_UNSUPPORTED,
                                "Draco compression is not supported: " HE_GLTF_UNDRACO);
        }
        if (!quantized && !packed && !begins_with_any(json, i, looks)) {
            he_quote(name, name + length, quoted, sizeof quoted);
            return he_json_fail(json, i, err, HE_UNSUPPORTED,
                                "the file needs the extension %s, which is not supported", quoted);
        }
    }
    list = he_json_find(json, 0, "extensionsUsed");
    for (uint32_t i = he_json_first(json, list); i != HE_NONE; i = he_json_after(json, list, i)) {
        if (he_json_is(json, i, HE_GLTF_EMISSIVE_STRENGTH)) {
            continue;
        }
        if (he_json_is(json, i, "KHR_mesh_quantization")) {
            asset->quantized = true;
        } else if (!he_json_is(json, i, HE_GLTF_MESHOPT)) {
            he_gltf_note(asset, "ignored_extension",
                         "extension % is ignored, because hedge does not read it", i, i);
        }
    }
    return HE_OK;
}

/* Warns about images, which a mesh cannot store. The files of images are marked as used, so that
 * there is no second warning that nothing refers to these files. */
static void note_images(he_gltf *asset)
{
    const he_json *json = &asset->json;
    uint32_t list = he_json_find(json, 0, "images");
    for (uint32_t i = he_json_first(json, list); i != HE_NONE; i = he_json_after(json, list, i)) {
        uint32_t name = he_json_find(json, i, "name"), uri = he_json_find(json, i, "uri");
        bool data = he_json_begins(json, uri, "data:");
        if (he_json_type(json, uri) == '"' && !data) {
            char text[HE_BESIDE_NAME];
            size_t length = he_json_string(json, uri, text, sizeof text);
            (void)he_beside_find_uri(asset->into->beside, text, length);
            name = uri;
        }
        he_gltf_note(asset, "ignored_images",
                     name == HE_NONE ? "an image is not kept, because a mesh stores no images"
                                     : "image % is not kept, because a mesh stores no images",
                     name, i);
    }
}

/* Warns about animations and skins, which a mesh cannot store. */
static void note_rest(he_gltf *asset)
{
    static const struct {
        const char *name, *code, *text;
    } parts[] = {{"animations", "ignored_animations",
                  "the animations of the file are ignored, because a mesh stores none"},
                 {"skins", "ignored_skins",
                  "the skins of the file are ignored, so each mesh is placed by its node alone"}};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        uint32_t list = he_json_find(&asset->json, 0, parts[i].name);
        if (he_json_first(&asset->json, list) != HE_NONE) {
            he_gltf_note(asset, parts[i].code, parts[i].text, HE_NONE, list);
        }
    }
}

he_status he_gltf_open(he_gltf *asset, he_import *into, const he_gltf_text *text,
                       const he_gltf_bin *bin, he_error *err)
{
    *asset = (he_gltf){
        .into = into, .size = (uint64_t)text->length + bin->length + he_beside_bytes(into->beside)};
    asset->room = HE_GLTF_ROOM + HE_GLTF_FACTOR * asset->size;
    asset->unpack_room = HE_GLTF_ROOM + HE_GLTF_UNPACKED * asset->size;
    he_progress *progress = into->soup.limits.progress;
    he_status status = he_progress_phase(progress, "parsing", 0.4, err);
    if (status == HE_OK) {
        status = he_json_parse(&asset->json, text->bytes, text->length, text->place, progress, err);
    }
    if (status == HE_OK) {
        status = he_progress_phase(progress, "reading", 1, err);
    }
    if (status == HE_OK) {
        status = check_version(asset, err);
    }
    if (status == HE_OK) {
        status = check_extensions(asset, err);
    }
    struct {
        const char *name;
        he_ids *list;
    } lists[] = {{"accessors", &asset->accessors},
                 {"bufferViews", &asset->views},
                 {"nodes", &asset->nodes},
                 {"meshes", &asset->meshes},
                 {"materials", &asset->materials}};
    for (size_t i = 0; i < sizeof lists / sizeof *lists && status == HE_OK; i++) {
        status = he_gltf_list(asset, lists[i].name, lists[i].list, err);
    }
    if (status == HE_OK) {
        status = he_gltf_open_buffers(asset, bin, err);
    }
    if (status != HE_OK) {
        he_gltf_close(asset);
        return status;
    }
    note_images(asset);
    note_rest(asset);
    return HE_OK;
}

void he_gltf_close(he_gltf *asset)
{
    for (size_t i = 0; i < asset->buffer_count; i++) {
        he_mem_free(asset->buffers[i].own);
    }
    he_mem_free(asset->buffers);
    for (size_t i = 0; asset->unpacked != NULL && i < asset->views.count; i++) {
        he_mem_free(asset->unpacked[i].own);
    }
    he_mem_free(asset->unpacked);
    he_ids_clear(&asset->accessors);
    he_ids_clear(&asset->views);
    he_ids_clear(&asset->nodes);
    he_ids_clear(&asset->meshes);
    he_ids_clear(&asset->materials);
    he_json_clear(&asset->json);
    *asset = (he_gltf){0};
}
