/* glb_describe.c - writes the JSON of a GLB file, which describes the parts of its buffer. */
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

/* Writes the primitive that has all faces, from which hedge's own reader restores the mesh. */
static void put_whole(text *t, const he_glb_parts *g)
{
    size_t triangles;
    bool faces = find_part(g, HE_GLB_TRIANGLES, &triangles) != NULL;
    put_attributes(t, g);
    if (faces) {
        put_number(t, ",\"indices\":", triangles);
    }
    put_text(t, faces ? ",\"mode\":4" : ",\"mode\":0");
    put_extras(t, g);
}

static void put_name(text *t, const char *before, const char *name)
{
    if (*name != '\0') {
        put_text(t, before);
        put_text(t, "\"name\":");
        put_string(t, name);
    }
}

static void put_material_of(text *t, const he_glb_parts *g, const he_glb_group *group)
{
    uint32_t material = he_glb_material(g->mesh, &g->groups, group);
    if (material != HE_NONE) {
        put_number(t, ",\"material\":", material);
    }
}

static bool same_mesh(const he_glb_group *a, const he_glb_group *b)
{
    return a->label[HE_GLB_OBJECT] == b->label[HE_GLB_OBJECT] &&
           a->label[HE_GLB_GROUP] == b->label[HE_GLB_GROUP];
}

/* Returns true if group i of the faces is the first group in its glTF mesh. */
static bool begins_mesh(const he_glb_parts *g, size_t i)
{
    return i == 0 || !same_mesh(&g->groups.list[i], &g->groups.list[i - 1]);
}

static size_t count_meshes(const he_glb_parts *g)
{
    size_t count = 0;
    for (size_t i = 0; i < g->groups.count; i++) {
        count += begins_mesh(g, i);
    }
    return count == 0 ? 1 : count;
}

/* Returns the name of a glTF node, which is the object that its faces belong to. The node's mesh
 * has the name of the group that the faces belong to. If one of these two names is empty, node
 * and mesh both get the other name. */
static const char *name_of_node(const he_glb_parts *g, const he_glb_group *group)
{
    const char *object = he_glb_name(&g->groups, group, HE_GLB_OBJECT);
    return *object != '\0' ? object : he_glb_name(&g->groups, group, HE_GLB_GROUP);
}

static const char *name_of_mesh(const he_glb_parts *g, const he_glb_group *group)
{
    const char *name = he_glb_name(&g->groups, group, HE_GLB_GROUP);
    return *name != '\0' ? name : name_of_node(g, group);
}

static void put_nodes(text *t, const he_glb_parts *g)
{
    size_t mesh = 0;
    put_text(t, ",\"nodes\":[");
    for (size_t i = 0; i < g->groups.count; i++) {
        if (begins_mesh(g, i)) {
            put_number(t, mesh > 0 ? ",{\"mesh\":" : "{\"mesh\":", mesh);
            put_name(t, ",", name_of_node(g, &g->groups.list[i]));
            put_text(t, "}");
            mesh++;
        }
    }
    put_text(t, mesh > 0 ? "]" : "{\"mesh\":0}]");
}

/* Writes one glTF mesh with one primitive, for a file whose faces are all in one group. The
 * extras (data of the application) of this primitive then describe all faces. */
static void put_one_mesh(text *t, const he_glb_parts *g)
{
    put_text(t, ",\"meshes\":[{");
    if (g->groups.count == 1) {
        const char *name = name_of_mesh(g, &g->groups.list[0]);
        put_name(t, "", name);
        put_text(t, *name != '\0' ? "," : "");
    }
    put_text(t, "\"primitives\":[{");
    put_whole(t, g);
    if (g->groups.count == 1) {
        put_material_of(t, g, &g->groups.list[0]);
    }
    put_text(t, "}]}]");
}

static void put_meshes(text *t, const he_glb_parts *g)
{
    put_nodes(t, g);
    if (g->groups.count < 2) {
        put_one_mesh(t, g);
        return;
    }
    put_text(t, ",\"meshes\":[");
    for (size_t i = 0; i < g->groups.count; i++) {
        const he_glb_group *group = &g->groups.list[i];
        if (begins_mesh(g, i)) {
            put_text(t, i > 0 ? "]},{" : "{");
            const char *name = name_of_mesh(g, group);
            put_name(t, "", name);
            put_text(t, *name != '\0' ? ",\"primitives\":[" : "\"primitives\":[");
        } else {
            put_text(t, ",");
        }
        put_text(t, "{");
        put_attributes(t, g);
        put_number(t, ",\"indices\":", g->count + i);
        put_text(t, ",\"mode\":4");
        put_material_of(t, g, group);
        put_text(t, "}");
    }
    put_text(t, "]}]");
}

/* --- materials --- */

static void put_double(text *t, const char *before, double value)
{
    char digits[HE_NUMBER_TEXT];
    put_text(t, before);
    put(t, digits, he_double_print(value, digits));
}

static void put_color(text *t, const char *name, const double *numbers, size_t count, double scale)
{
    put_text(t, name);
    for (size_t i = 0; i < count; i++) {
        put_double(t, i == 0 ? "[" : ",", numbers[i] / scale);
    }
    put_text(t, "]");
}

/* Returns the smallest power of two, at least 1, that no component of a material's emission
 * exceeds. The file has the emission divided by this power, and dividing by a power of two is
 * exact. */
static double strength_of(const he_look *look)
{
    double strength = 1;
    for (size_t i = 0; i < 3; i++) {
        while (strength < look->emission[i] && strength < DBL_MAX / 2) {
            strength *= 2;
        }
    }
    return strength;
}

static void put_row(text *t, const he_material *row, bool *strong)
{
    const he_look *look = &row->look;
    double strength = strength_of(look);
    put_name(t, "{", row->name);
    put_color(t, ",\"pbrMetallicRoughness\":{\"baseColorFactor\":", look->base_color, 4, 1);
    put_double(t, ",\"metallicFactor\":", look->metallic);
    put_double(t, ",\"roughnessFactor\":", look->roughness);
    put_color(t, "},\"emissiveFactor\":", look->emission, 3, strength);
    if (strength > 1) {
        *strong = true;
        put_double(t, ",\"extensions\":{\"" HE_GLTF_EMISSIVE_STRENGTH "\":{\"emissiveStrength\":",
                   strength);
        put_text(t, "}}");
    }
    put_text(t, look->base_color[3] < 1 ? ",\"alphaMode\":\"BLEND\"" : "");
    put_text(t, look->two_sided ? ",\"doubleSided\":true}" : "}");
}

/* Writes the list of materials: first those of the mesh's table of materials, then those that are
 * only names and not in the table. */
static void put_materials(text *t, const he_glb_parts *g, bool *strong)
{
    const he_materials *table = he_mesh_materials(g->mesh);
    static const char first[] = ",\"materials\":[";
    bool any = false;
    for (size_t i = 0; i < table->count; i++) {
        if (table->rows[i] != NULL) {
            put_text(t, any ? "," : first);
            put_row(t, table->rows[i], strong);
            any = true;
        }
    }
    for (size_t i = 0; i < g->groups.only_names.count; i++) {
        const he_labels *labels = g->groups.names[HE_GLB_MATERIAL]->labels;
        put_text(t, any ? "," : first);
        put_name(t, "{", he_labels_get(labels, g->groups.only_names.ids[i]));
        put_text(t, ",\"extras\":{\"hedge\":\"name\"}}");
        any = true;
    }
    put_text(t, any ? "]" : "");
}

/* Writes the names of all materials to the extras, so that a reader notices if another program has
 * changed the materials. */
static void put_names(text *t, const he_glb_parts *g)
{
    const he_materials *table = he_mesh_materials(g->mesh);
    const char *between = "";
    put_text(t, ",\"materials\":[");
    for (size_t i = 0; i < table->count; i++) {
        if (table->rows[i] != NULL) {
            put_text(t, between);
            put_string(t, table->rows[i]->name);
            between = ",";
        }
    }
    for (size_t i = 0; i < g->groups.only_names.count; i++) {
        const he_labels *labels = g->groups.names[HE_GLB_MATERIAL]->labels;
        put_text(t, between);
        put_string(t, he_labels_get(labels, g->groups.only_names.ids[i]));
        between = ",";
    }
    put_text(t, "]");
}

/* Writes the extras at the root of the JSON. In a file with several groups of faces, these
 * extras describe how to make one mesh of the groups again: see gltf_whole.h. */
static void put_root_extras(text *t, const he_glb_parts *g)
{
    size_t order;
    if (find_part(g, HE_GLB_ORDER, &order) == NULL) {
        return;
    }
    put_number(t, ",\"extras\":{\"hedge\":{\"order\":", order);
    put_names(t, g);
    put_text(t, ",\"primitive\":{");
    put_whole(t, g);
    put_text(t, "}}}");
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

/* Writes an accessor for each group of faces. The elements of the accessor are the triangles of
 * that group, a range of all triangles. */
static void put_group_accessors(text *t, const he_glb_parts *g)
{
    size_t triangles;
    const he_glb_part *part = find_part(g, HE_GLB_TRIANGLES, &triangles);
    for (size_t i = 0; part != NULL && g->groups.count > 1 && i < g->groups.count; i++) {
        put_number(t, ",{\"bufferView\":", triangles);
        put_number(t, ",\"byteOffset\":", 3 * g->groups.list[i].first * part->stride);
        put_number(t, ",\"componentType\":", part->type);
        put_number(t, ",\"count\":", 3 * g->groups.list[i].triangles);
        put_text(t, ",\"type\":\"SCALAR\"}");
    }
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
    put_group_accessors(t, g);
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
    put_number(t, ",\"buffers\":[{\"byteLength\":", he_glb_bin_bytes(g));
    put_text(t, "}");
    if (g->packs) {
        put_number(t, ",{\"byteLength\":", g->bytes);
        put_text(t, ",\"extensions\":{\"" HE_GLTF_MESHOPT "\":{\"fallback\":true}}}");
    }
    put_text(t, "]");
}

static void put_extensions(text *t, bool packs, bool strong)
{
    if (packs || strong) {
        put_text(t, ",\"extensionsUsed\":[");
        put_text(t, packs ? "\"" HE_GLTF_MESHOPT "\"" : "");
        put_text(t, packs && strong ? "," : "");
        put_text(t, strong ? "\"" HE_GLTF_EMISSIVE_STRENGTH "\"]" : "]");
    }
    put_text(t, packs ? ",\"extensionsRequired\":[\"" HE_GLTF_MESHOPT "\"]" : "");
}

static void put_scene(text *t, const he_glb_parts *g)
{
    put_text(t,
             "{\"asset\":{\"version\":\"2.0\",\"generator\":\"hedge\"},\"scene\":0,\"scenes\":[{");
    for (size_t i = 0; g->count > 0 && i < count_meshes(g); i++) {
        put_number(t, i == 0 ? "\"nodes\":[" : ",", i);
    }
    put_text(t, g->count > 0 ? "]}]" : "}]");
}

he_status he_glb_describe(he_glb_parts *g, he_error *err)
{
    text t = {0};
    bool strong = false;
    put_scene(&t, g);
    put_materials(&t, g, &strong);
    if (g->count > 0) {
        put_meshes(&t, g);
        put_accessors(&t, g);
        put_views(&t, g);
        put_buffers(&t, g);
        put_root_extras(&t, g);
    }
    put_extensions(&t, g->packs && g->count > 0, strong);
    put_text(&t, "}");
    while (!t.failed && t.length % 4 != 0) {
        put_text(&t, " ");
    }
    if (t.failed) {
        he_mem_free(t.bytes);
        return he_fail_plain(err, HE_NO_MEMORY, "no memory for the JSON that describes %zu parts",
                             g->count);
    }
    g->json = t.bytes;
    g->json_length = t.length;
    uint64_t bytes = he_glb_bin_bytes(g) + g->json_length;
    return bytes <= UINT32_MAX - 64
               ? HE_OK
               : he_fail_plain(err, HE_LIMIT, "a GLB file has less than 4 GiB, not %llu bytes",
                               (unsigned long long)bytes);
}
