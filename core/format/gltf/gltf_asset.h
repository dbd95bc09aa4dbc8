/* gltf_asset.h - the parts of a glTF asset from which geometry is read: its JSON, its buffers, and
 * accessors, each checked when it is used.
 *
 * The soup made from an asset may take at most HE_GLTF_ROOM bytes plus HE_GLTF_FACTOR times the
 * size of the asset. There is a bound because nodes share meshes and primitives share accessors: a
 * few bytes could ask for many copies of a mesh. Memory is counted before it is allocated.
 *
 * A buffer view with EXT_meshopt_compression is decompressed when it is first used. All such views
 * together may decompress to at most HE_GLTF_ROOM bytes plus HE_GLTF_UNPACKED times the size of the
 * asset (meshes decompress to 2 to 12 times their size, zeros to 64 times). The bound on the memory
 * of the soup grows by twice the number of decompressed bytes. */
#ifndef HE_FORMAT_GLTF_GLTF_ASSET_H
#define HE_FORMAT_GLTF_GLTF_ASSET_H

#include "format/io/format.h"
#include "format/text/json.h"

#define HE_GLTF_ROOM     ((uint64_t)32 << 20)
#define HE_GLTF_FACTOR   ((uint64_t)8)
#define HE_GLTF_UNPACKED ((uint64_t)16)
#define HE_GLTF_NOWHERE  UINT64_MAX
/* Advice about KHR_draco_mesh_compression, for messages. */
#define HE_GLTF_UNDRACO           "unpack it first, as \"gltf-transform copy IN.glb OUT.glb\" does"
#define HE_GLTF_EMISSIVE_STRENGTH "KHR_materials_emissive_strength"
enum { HE_GLTF_ELEMENT = 64 }; /* bytes of the largest element: sixteen floats */

typedef struct he_gltf_buffer {
    /* The bytes of the buffer; NULL if it is a fallback buffer whose file was not uploaded. */
    const unsigned char *bytes;
    /* The memory to free; NULL unless the bytes were decoded or decompressed. */
    unsigned char *own;
    uint64_t length;
    uint64_t start; /* offset in a buffer of the asset, if these bytes are a part of that buffer */
    uint64_t place; /* offset of the first byte in the file that is read; HE_GLTF_NOWHERE if the
                     * bytes are not in that file */
} he_gltf_buffer;

typedef struct he_gltf {
    he_import *into;
    he_json json;
    he_ids accessors, views, nodes, meshes,
        materials; /* the JSON objects of each kind, in the order of their indices in the asset */
    he_gltf_buffer *buffers;
    size_t buffer_count;
    he_gltf_buffer *unpacked; /* the decompressed bytes of each view; NULL before the first view is
                                 decompressed */
    bool quantized;           /* KHR_mesh_quantization is used */
    uint64_t room;            /* how many more bytes of memory the soup may take */
    uint64_t unpack_room;     /* how many more bytes buffer views may decompress to */
    uint64_t size;            /* bytes of the input */
    /* steps: how many steps of work are done; told: how many of them were reported as progress. */
    uint64_t steps, told;
} he_gltf;

/* The BIN chunk of a GLB file; `bytes` is NULL if the file has none. */
typedef struct he_gltf_bin {
    const unsigned char *bytes;
    uint64_t length, place;
} he_gltf_bin;

/* The JSON text of an asset. */
typedef struct he_gltf_text {
    const char *bytes;
    size_t length;
    uint64_t place; /* offset of the text in the file */
} he_gltf_text;

/* Parses a glTF asset and checks its version, extensions and buffers. `text` and `bin` must outlive
 * the asset.
 * Returns HE_SYNTAX, HE_BAD_VALUE or HE_UNSUPPORTED if the asset is not valid.
 * Returns HE_LIMIT if the asset is too large.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_gltf_open(he_gltf *asset, he_import *into, const he_gltf_text *text,
                                    const he_gltf_bin *bin, he_error *err);
void he_gltf_close(he_gltf *asset);

/* --- functions that the readers of accessors, materials and scenes share --- */

/* Opens the buffers. */
HE_NODISCARD he_status he_gltf_open_buffers(he_gltf *asset, const he_gltf_bin *bin, he_error *err);
/* Decompresses a buffer view. `view` is its JSON object; the JSON object `extension` says how the
 * view is compressed.
 * Returns HE_BAD_INDEX, HE_BAD_VALUE or HE_UNSUPPORTED if the view is not valid.
 * Returns HE_LIMIT if the asset would decompress to too many bytes.
 * Returns HE_NO_MEMORY if memory is out.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_gltf_unpack(he_gltf *asset, uint32_t view, uint32_t extension,
                                      const he_gltf_buffer **out, he_error *err);
/* Finds the bytes to which `object` refers by its members buffer, byteOffset and byteLength.
 * Returns HE_BAD_INDEX or HE_BAD_VALUE if there are no such bytes. */
HE_NODISCARD he_status he_gltf_buffer_part(he_gltf *asset, uint32_t object, he_gltf_buffer *out,
                                           he_error *err);
/* Lists the objects in the array `name`, which is a member of the outermost object of the JSON. */
HE_NODISCARD he_status he_gltf_list(he_gltf *asset, const char *name, he_ids *list, he_error *err);
/* Adds a warning about the JSON value `place`. The subject of the warning is the JSON string
 * `subject`; if `subject` is HE_NONE, the warning has none, and no % in its text. */
void he_gltf_note(he_gltf *asset, const char *code, const char *text, uint32_t subject,
                  uint32_t place);
/* Adds a warning about the JSON value `place`, with a subject that is text. */
void he_gltf_note_text(he_gltf *asset, const char *code, const char *text, const char *subject,
                       uint32_t place);
/* Adds the warning that hedge's own data at the JSON value `place` does not fit the geometry. */
void he_gltf_note_stale(he_gltf *asset, uint32_t place);

/* Reports progress.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD he_status he_gltf_tell(he_gltf *asset, he_error *err);
/* The caller must call this function for each element that it visits. Progress is reported once in
 * HE_PROGRESS_STRIDE calls.
 * Returns HE_CANCELLED if the work was cancelled. */
HE_NODISCARD static inline he_status he_gltf_poll(he_gltf *asset, he_error *err)
{
    return ++asset->steps - asset->told < HE_PROGRESS_STRIDE ? HE_OK : he_gltf_tell(asset, err);
}
/* Subtracts `bytes` from the memory that reading the asset may still take.
 * Returns HE_LIMIT, naming the JSON value `value`, if less memory than that is left. */
HE_NODISCARD he_status he_gltf_spend(he_gltf *asset, uint32_t value, uint64_t bytes, he_error *err);
/* Finds the item of `list` whose index is the JSON number at `value`. Messages call the item by the
 * word `what`, such as "buffer view".
 * Returns HE_BAD_INDEX if there is no such item. */
HE_NODISCARD he_status he_gltf_item(he_gltf *asset, const he_ids *list, uint32_t value,
                                    const char *what, uint32_t *item, he_error *err);
/* The whole numbers from `least` to `most`, both included. */
typedef struct he_gltf_range {
    uint64_t least, most;
} he_gltf_range;

/* Reads the member `name` of a JSON object, which must exist and be a whole number in a range.
 * Returns HE_BAD_VALUE if the member does not exist or is not in the range. */
HE_NODISCARD he_status he_gltf_need(const he_gltf *asset, uint32_t object, const char *name,
                                    he_gltf_range range, uint64_t *out, he_error *err);
/* Reads the member `name` of a JSON object: a whole number up to `most`, or 0 if the member is
 * missing.
 * Returns HE_BAD_VALUE if the member is not such a number. */
HE_NODISCARD he_status he_gltf_may(const he_gltf *asset, uint32_t object, const char *name,
                                   uint64_t most, uint64_t *out, he_error *err);
/* Finds the array `name` that is a member of `object`; *out becomes HE_NONE if there is no such
 * member.
 * Returns HE_BAD_VALUE if the member is no array. */
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

/* An accessor: a list of elements, each of one or more numbers. The elements were checked to be
 * inside their buffers. */
typedef struct he_gltf_accessor {
    uint32_t value; /* the accessor's object in the JSON */
    he_gltf_type type;
    bool normalized;
    bool matrix;
    uint32_t components;
    uint64_t count;
    const unsigned char *bytes; /* the bytes of the elements; NULL if all elements are zero */
    size_t stride;
    uint64_t place; /* offset of the first element in the file that is read; HE_GLTF_NOWHERE if the
                     * elements are not in that file */
    uint64_t changed; /* number of elements that a sparse accessor replaces */
    const unsigned char *changed_index, *changed_value;
    he_gltf_type changed_type; /* type of the indices of replaced elements; the indices are in
                                  rising order */
} he_gltf_accessor;

/* he_gltf_meshopt returns the JSON value of the extension EXT_meshopt_compression in a view or
 * buffer; HE_NONE if the view or buffer does not have the extension. */
#define HE_GLTF_MESHOPT "EXT_meshopt_compression"
uint32_t he_gltf_meshopt(const he_gltf *asset, uint32_t object);

/* Finds the accessor whose index is the JSON number at `value`, and checks the accessor.
 * Returns HE_BAD_INDEX, HE_BAD_VALUE or HE_UNSUPPORTED if the accessor is not valid. */
HE_NODISCARD he_status he_gltf_accessor_get(he_gltf *asset, uint32_t value, he_gltf_accessor *out,
                                            he_error *err);

/* The position of a walk over the elements of an accessor. */
typedef struct he_gltf_walk {
    const he_gltf_accessor *accessor;
    uint64_t next, changed;
} he_gltf_walk;

/* Returns the bytes of the walk's next element. */
const unsigned char *he_gltf_next(he_gltf_walk *walk);
/* Returns a component of an element as the number it stands for. A normalized integer stands for a
 * fraction from 0 to 1, or from -1 to 1 if it is signed. */
double he_gltf_number(const he_gltf_accessor *accessor, const unsigned char *element,
                      uint32_t component);
/* Reads a whole number of an unsigned type at the address `at`. */
uint32_t he_gltf_whole(he_gltf_type type, const unsigned char *at);

#endif
