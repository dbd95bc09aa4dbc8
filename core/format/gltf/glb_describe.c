/* he_glb_describe of glb_parts.h: the JSON. */
#include "format/gltf/glb_parts.h"

#include "format/gltf/gltf_asset.h"
#include "format/io/export.h"
#include "format/text/number.h"

#include <string.h>

typedef struct text {
    char *bytes;
    size_t length, capacity;
    bool failed;
} text;

static void put(text *t, const char *bytes, size_t n)
{
    if (t->failed) {
        return;
    }
    if (t->capacity - t->length < n) {
        size_t capacity = he_mem_grown(t->capacity, t->length + n + 256);
        char *grown = he_mem_resize(t->bytes, capacity);
        if (grown == NULL) {
            t->failed = true;
            return;
        }
        t->bytes = grown;
        t->capacity = capacity;
    }
    memcpy(t->bytes + t->length, bytes, n);
    t->length += n;
}

static void put_text(text *t, const char *words)
{
    put(t, words, strlen(words));
}

static void put_number(text *t, const char *before, uint64_t number)
{
    char digits[HE_NUMBER_TEXT];
    put_text(t, before);
    put(t, digits, he_u64_print(number, digits));
}

static void put_string(text *t, const char *words)
{
    static const char digits[] = "0123456789abcdef";
    put_text(t, "\"");
    for (const char *p = words; *p != '\0'; p++) {
        unsigned char c = (unsigned char)*p;
        char escape[6] = {'\\', 'u', '0', '0', digits[c >> 4], digits[c & 15]};
        if (c < 0x20) {
            put(t, escape, sizeof escape);
        } else {
            put(t, "\\", *p == '"' || *p == '\\' ? 1 : 0);
            put(t, p, 1);
        }
    }
    put_text(t, "\"");
}

/* --- the primitive --- */

static const he_glb_part *find_part(const he_glb_parts *g, he_glb_content content, size_t *i)
{
    for (*i = 0; *i < g->count; ++*i) {
        if (g->parts[*i].content == content) {
            return &g->parts[*i];
        }
    }
    return NULL;
}

static void put_attributes(text *t, const he_glb_parts *g)
{
    put_text(t, "\"attributes\":{");
    for (size_t i = 0; i < g->count; i++) {
        if (g->parts[i].semantic[0] != '\0') {
            put_text(t, i > 0 ? "," : "");
            put_string(t, g->parts[i].semantic);
            put_number(t, ":", i);
        }
    }
    put_text(t, "}");
}

static void put_column(text *t, const he_column *column, size_t i)
{
    put_text(t, "{\"domain\":");
    put_string(t, he_kind_name(column->domain));
    put_text(t, ",\"name\":");
    put_string(t, column->name);
    put_text(t, ",\"type\":");
    put_string(t, he_type_name(column->type));
    put_number(t, ",\"components\":", column->components);
    put_text(t, ",\"rule\":");
    put_string(t, he_rule_name(column->rule));
    put_number(t, ",\"accessor\":", i);
    size_t labels = column->labels == NULL ? 0 : he_labels_count(column->labels);
    for (size_t k = 0; k < labels; k++) {
        put_text(t, k == 0 ? ",\"labels\":[" : ",");
        put_string(t, he_labels_get(column->labels, k));
    }
    put_text(t, labels > 0 ? "]}" : "}");
}

static void put_extras(text *t, const he_glb_parts *g)
{
    size_t degrees, corners;
    bool polygons = find_part(g, HE_GLB_DEGREES, &degrees) != NULL &&
                    find_part(g, HE_GLB_CORNERS, &corners) != NULL;
    size_t copies;
    const char *between = "";
    put_text(t, ",\"extras\":{\"hedge\":{");
    if (find_part(g, HE_GLB_COPIES, &copies) != NULL) {
        put_number(t, "\"copies\":", copies);
        between = ",";
    }
    if (polygons) {
        put_text(t, between);
        put_number(t, "\"polygons\":{\"degrees\":", degrees);
        put_number(t, ",\"corners\":", corners);
        put_text(t, "}");
        between = ",";
    }
    size_t columns = 0;
    for (size_t i = 0; i < g->count; i++) {
        if (g->parts[i].content == HE_GLB_WORDS) {
            put_text(t, columns > 0 ? "," : between);
            put_text(t, columns > 0 ? "" : "\"columns\":[");
            put_column(t, g->parts[i].column, i);
            columns++;
        }
    }
    put_text(t, columns > 0 ? "]}}" : "}}");
}

static void put_meshes(text *t, const he_glb_parts *g)
{
    size_t triangles;
    bool faces = find_part(g, HE_GLB_TRIANGLES, &triangles) != NULL;
    put_text(t, ",\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{");
    put_attributes(t, g);
    if (faces) {
        put_number(t, ",\"indices\":", triangles);
    }
    put_text(t, faces ? ",\"mode\":4" : ",\"mode\":0");
    put_extras(t, g);
    put_text(t, "}]}]");
}

/* --- accessors and views --- */

static void put_box(text *t, const he_mesh *m)
{
    float box[2][3] = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
    for (uint32_t v = 0; v < m->c.vertices.issued; v++) {
        const double *p = &m->c.position[v].x;
        for (size_t i = 0; i < 3 && he_vertex_is_live(m, (he_vertex){v}); i++) {
            float value = he_narrow(p[i]);
            box[0][i] = value < box[0][i] ? value : box[0][i];
            box[1][i] = value > box[1][i] ? value : box[1][i];
        }
    }
    for (size_t side = 0; side < 2; side++) {
        put_text(t, side == 0 ? ",\"min\":[" : "],\"max\":[");
        for (size_t i = 0; i < 3; i++) {
            char digits[HE_NUMBER_TEXT];
            put_text(t, i > 0 ? "," : "");
            put(t, digits, he_float_print(box[side][i], digits));
        }
    }
    put_text(t, "]");
}

static void put_accessors(text *t, const he_glb_parts *g)
{
    static const char *const shapes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    for (size_t i = 0; i < g->count; i++) {
        const he_glb_part *part = &g->parts[i];
        put_number(t, i > 0 ? ",{\"bufferView\":" : ",\"accessors\":[{\"bufferView\":", i);
        put_number(t, ",\"componentType\":", part->type);
        put_number(t, ",\"count\":", part->count);
        put_text(t, ",\"type\":");
        put_string(t, shapes[part->components]);
        put_text(t, part->normalized ? ",\"normalized\":true" : "");
        if (part->content == HE_GLB_POSITIONS) {
            put_box(t, g->mesh);
        }
        put_text(t, "}");
    }
    put_text(t, "]");
}

static void put_stream(text *t, const he_glb_part *part)
{
    const he_meshopt_stream stream = he_glb_part_stream(part);
    put_text(t, ",\"extensions\":{\"" HE_GLTF_MESHOPT "\":{\"buffer\":0");
    put_number(t, ",\"byteOffset\":", part->packed_at);
    put_number(t, ",\"byteLength\":", part->packed);
    put_number(t, ",\"byteStride\":", stream.stride);
    put_number(t, ",\"count\":", stream.count);
    put_text(t, ",\"mode\":");
    put_string(t, he_meshopt_modes[stream.mode]);
    put_text(t, "}}");
}

static void put_views(text *t, const he_glb_parts *g)
{
    for (size_t i = 0; i < g->count; i++) {
        const he_glb_part *part = &g->parts[i];
        put_text(t, i > 0 ? ",{" : ",\"bufferViews\":[{");
        put_number(t, "\"buffer\":", g->packs ? 1 : 0);
        put_number(t, ",\"byteOffset\":", part->offset);
        put_number(t, ",\"byteLength\":", he_glb_part_bytes(part));
        if (part->content == HE_GLB_POSITIONS || part->content == HE_GLB_VALUES) {
            put_number(t, ",\"byteStride\":", part->stride);
            put_text(t, ",\"target\":34962");
        } else if (part->content == HE_GLB_TRIANGLES) {
            put_text(t, ",\"target\":34963");
        }
        if (g->packs) {
            put_stream(t, part);
        }
        put_text(t, "}");
    }
    put_text(t, "]");
}

static void put_buffers(text *t, const he_glb_parts *g)
{
    static const char name[] = "\":[\"" HE_GLTF_MESHOPT "\"]";
    put_number(t, ",\"buffers\":[{\"byteLength\":", he_glb_bin_bytes(g));
    put_text(t, "}");
    if (g->packs) {
        put_number(t, ",{\"byteLength\":", g->bytes);
        put_text(t, ",\"extensions\":{\"" HE_GLTF_MESHOPT "\":{\"fallback\":true}}}");
    }
    put_text(t, "]");
    if (g->packs) {
        put_text(t, ",\"extensionsUsed");
        put_text(t, name);
        put_text(t, ",\"extensionsRequired");
        put_text(t, name);
    }
}

he_status he_glb_describe(he_glb_parts *g, he_error *err)
{
    text t = {0};
    put_text(&t,
             "{\"asset\":{\"version\":\"2.0\",\"generator\":\"hedge\"},\"scene\":0,\"scenes\":[");
    put_text(&t, g->count > 0 ? "{\"nodes\":[0]}]" : "{}]");
    if (g->count > 0) {
        put_meshes(&t, g);
        put_accessors(&t, g);
        put_views(&t, g);
        put_buffers(&t, g);
    }
    put_text(&t, "}");
    while (!t.failed && t.length % 4 != 0) {
        put_text(&t, " ");
    }
    if (t.failed) {
        he_mem_free(t.bytes);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the JSON of %zu parts", g->count);
    }
    g->json = t.bytes;
    g->json_length = t.length;
    uint64_t bytes = he_glb_bin_bytes(g) + g->json_length;
    return bytes <= UINT32_MAX - 64
               ? HE_OK
               : he_fail_plain(err, HE_LIMIT, "a GLB file has less than 4 GiB, not %llu bytes",
                               (unsigned long long)bytes);
}
