/* gltf_asset.h - the parts of a glTF asset that geometry is read from: its JSON, the buffers behind
 * it, and accessors, each checked when it is used.
 *
 * What an asset may make is bounded by its size, since nodes share meshes and primitives share
 * accessors: HE_GLTF_ROOM bytes and HE_GLTF_FACTOR times its own, counted as they are in the soup,
 * before anything is made. So a list of instances that grows without bytes is refused early.
 *
 * A buffer view with EXT_meshopt_compression is unpacked when it is first used. All of them may
 * unpack to HE_GLTF_ROOM bytes and HE_GLTF_UNPACKED times the asset's own, and what they do unpack
 * to may make twice as much more: meshes come to 2 to 12 times their compressed bytes, zeros to
 * 64. */
#ifndef HE_FORMAT_GLTF_GLTF_ASSET_H
#define HE_FORMAT_GLTF_GLTF_ASSET_H

#include "format/io/format.h"
#include "format/text/json.h"

#define HE_GLTF_ROOM     ((uint64_t)32 << 20)
#define HE_GLTF_FACTOR   ((uint64_t)8)
#define HE_GLTF_UNPACKED ((uint64_t)16)
#define HE_GLTF_NOWHERE  UINT64_MAX
/* What to do about KHR_draco_mesh_compression, for messages. */
#define HE_GLTF_UNDRACO           "unpack it first, as \"gltf-transform copy IN.glb OUT.glb\" does"
#define HE_GLTF_EMISSIVE_STRENGTH "KHR_materials_emissive_strength"
enum { HE_GLTF_ELEMENT = 64 }; /* bytes of the largest element, sixteen floats */

typedef struct he_gltf_buffer {
    const unsigned char *bytes; /* NULL: a fallback that is not there */
    unsigned char *own;         /* to be freed: what a data: URI held, or was unpacked */
    uint64_t length;
    uint64_t start; /* of a part, in the buffer that it is of */
    uint64_t place; /* of its first byte in the input, or HE_GLTF_NOWHERE */
} he_gltf_buffer;

typedef struct he_gltf {
    he_import *into;
    he_json json;
    he_ids accessors, views, nodes, meshes, materials; /* their values in the JSON */
    he_gltf_buffer *buffers;
    size_t buffer_count;
    he_gltf_buffer *unpacked; /* of each view, NULL before there is any */
    bool quantized;           /* KHR_mesh_quantization is used */
    uint64_t room;            /* bytes that may still be made, */
    uint64_t unpack_room;     /* and unpacked */
    uint64_t size;            /* bytes of the input */
    uint64_t steps, told;     /* of work; when the watch was last told */
} he_gltf;

/* Where the BIN chunk of a GLB lies; bytes NULL: there is none. */
typedef struct he_gltf_bin {
    const unsigned char *bytes;
    uint64_t length, place;
} he_gltf_bin;

/* Parse and check what concerns the whole: version, extensions, buffers. `text` and `bin` must
 * outlive the asset. HE_SYNTAX, HE_BAD_VALUE, HE_UNSUPPORTED, HE_LIMIT, HE_NO_MEMORY,
 * HE_CANCELLED. */
HE_NODISCARD he_status he_gltf_open(he_gltf *asset, he_import *into, const char *text,
                                    size_t length, uint64_t offset, const he_gltf_bin *bin,
                                    he_error *err);
void he_gltf_close(he_gltf *asset);

/* --- for the files that include this header --- */

/* Opens the buffers. */
HE_NODISCARD he_status he_gltf_open_buffers(he_gltf *asset, const he_gltf_bin *bin, he_error *err);
/* Decompresses a view (a value of the JSON); the object `extension` says how. HE_BAD_INDEX,
 * HE_BAD_VALUE, HE_UNSUPPORTED, HE_LIMIT, HE_NO_MEMORY, HE_CANCELLED. */
HE_NODISCARD he_status he_gltf_unpack(he_gltf *asset, uint32_t view, uint32_t extension,
                                      const he_gltf_buffer **out, he_error *err);
/* Finds the bytes that `object` names by buffer, byteOffset and byteLength. HE_BAD_INDEX,
 * HE_BAD_VALUE. */
HE_NODISCARD he_status he_gltf_buffer_part(he_gltf *asset, uint32_t object, he_gltf_buffer *out,
                                           he_error *err);
/* Lists the objects in an array that is a member of the root. */
HE_NODISCARD he_status he_gltf_list(he_gltf *asset, const char *name, he_ids *list, he_error *err);
/* Adds a note about `place`; its subject is the string `subject`, or HE_NONE. */
void he_gltf_note(he_gltf *asset, const char *code, const char *text, uint32_t subject,
                  uint32_t place);

/* HE_CANCELLED. */
HE_NODISCARD he_status he_gltf_tell(he_gltf *asset, he_error *err);
/* To be called for each element that is looked at: once in HE_WATCH_STRIDE calls the soup's watch
 * is asked whether to go on. HE_CANCELLED. */
HE_NODISCARD static inline he_status he_gltf_poll(he_gltf *asset, he_error *err)
{
    return ++asset->steps - asset->told < HE_WATCH_STRIDE ? HE_OK : he_gltf_tell(asset, err);
}
/* HE_LIMIT, naming `value`, where `bytes` more are more than the asset may make. */
HE_NODISCARD he_status he_gltf_spend(he_gltf *asset, uint32_t value, uint64_t bytes, he_error *err);
/* The item of `list` that the number at `value` names: HE_BAD_INDEX. `what` is one of them. */
HE_NODISCARD he_status he_gltf_item(he_gltf *asset, const he_ids *list, uint32_t value,
                                    const char *what, uint32_t *item, he_error *err);
/* Reads the whole number of a member that must be there. HE_BAD_VALUE. */
HE_NODISCARD he_status he_gltf_need(const he_gltf *asset, uint32_t object, const char *name,
                                    uint64_t least, uint64_t most, uint64_t *out, he_error *err);
/* Reads the whole number of a member, 0 where it is missing. HE_BAD_VALUE. */
HE_NODISCARD he_status he_gltf_may(const he_gltf *asset, uint32_t object, const char *name,
                                   uint64_t most, uint64_t *out, he_error *err);
/* The array that a member is, HE_NONE where there is no such member. HE_BAD_VALUE. */
HE_NODISCARD he_status he_gltf_array(const he_gltf *asset, uint32_t object, const char *name,
                                     uint32_t *out, he_error *err);

typedef enum he_gltf_type {
    HE_GLTF_INT8 = 5120,
    HE_GLTF_UINT8,
    HE_GLTF_INT16,
    HE_GLTF_UINT16,
    HE_GLTF_UINT32 = 5125,
    HE_GLTF_FLOAT
} he_gltf_type;

size_t he_gltf_type_bytes(he_gltf_type type);

/* Elements of numbers, checked to lie within their buffers. */
typedef struct he_gltf_accessor {
    uint32_t value; /* in the JSON */
    he_gltf_type type;
    bool normalized;
    bool matrix;
    uint32_t components;
    uint64_t count;
    const unsigned char *bytes; /* NULL: zeros */
    size_t stride;
    uint64_t place;   /* of the first element in the input, or HE_GLTF_NOWHERE */
    uint64_t changed; /* elements that differ from `bytes` */
    const unsigned char *changed_index, *changed_value;
    he_gltf_type changed_type; /* of the indices, which rise */
} he_gltf_accessor;

/* What a view or buffer has of the extension, HE_NONE where nothing. */
#define HE_GLTF_MESHOPT "EXT_meshopt_compression"
uint32_t he_gltf_meshopt(const he_gltf *asset, uint32_t object);

/* The accessor that the number at `value` names. HE_BAD_INDEX, HE_BAD_VALUE, HE_UNSUPPORTED. */
HE_NODISCARD he_status he_gltf_accessor_get(he_gltf *asset, uint32_t value, he_gltf_accessor *out,
                                            he_error *err);

/* A walk over the elements. */
typedef struct he_gltf_walk {
    const he_gltf_accessor *accessor;
    uint64_t next, changed;
} he_gltf_walk;

/* The bytes of the next element. */
const unsigned char *he_gltf_next(he_gltf_walk *walk);
/* A component, as the number it stands for: -1 to 1 or 0 to 1 where it is normalized. */
double he_gltf_number(const he_gltf_accessor *accessor, const unsigned char *element,
                      uint32_t component);
/* A whole number of a type without a sign. */
uint32_t he_gltf_whole(he_gltf_type type, const unsigned char *at);

#endif
