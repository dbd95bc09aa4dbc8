#include "api/describe/parameters.h"

#include "algo/decimate.h"
#include "api/header/sorted_cursor.h"
#include "api/json/attribute_value.h"
#include "api/limits.h"
#include "repair/repair.h"

#include <float.h>

static const char *const formats[] = {"obj", "off", "ply", "stl", "glb", "gltf", "json", NULL};
static const char *const formats_out[] = {"obj", "mtl", "off", "ply", "stl", "glb", "json", NULL};
static const char *const encodings[] = {"ascii", "binary", "binary_big_endian", NULL};
static const char *const compressions[] = {"meshopt", NULL};
static const char *const connections[] = {"vertex", "edge", NULL};

const api_parameter api_parameter_limit = {
    "limit", API_PARAM_U64, 1, API_MAX_PAGE, NULL, "The largest number of items in a page."};
const api_parameter api_parameter_cursor = {
    "cursor", API_PARAM_TEXT, 0, API_MAX_URI, NULL, "The value of `next` in the previous page."};
const api_parameter api_parameter_sort = {
    "sort",
    API_PARAM_CHOICE,
    0,
    0,
    api_order_names,
    "The order of the meshes. name: ascending, with the letters A to Z as a to z, and equal names "
    "in the order of ids. modified: the mesh that was changed last comes first. bytes: the mesh "
    "that takes the most memory comes first. Meshes with equal times or sizes are in the reverse "
    "order of ids. Default: the order of ids."};
const api_parameter api_parameter_contains = {
    "contains",
    API_PARAM_TEXT,
    0,
    ST_MESH_NAME,
    NULL,
    "Only meshes whose names contain this text; the letters A to Z are the same as a to z. One "
    "request looks at 20,000 meshes at most, so a page may be short or empty although there is a "
    "next page: the list ends only when `next` is null. Only with `sort`, for a token that is "
    "limited "
    "to prefixes of ids, a request looks at all meshes that the token can see."};
const api_parameter api_parameter_revision = {
    "revision", API_PARAM_U64, 1,
    0x1p53,     NULL,          "An earlier revision that the history still holds."};
const api_parameter api_parameter_embed = {
    "embed",
    API_PARAM_TEXT,
    0,
    API_MAX_URI,
    NULL,
    "The page shows only the view, for a frame of another page. The value may be left out."};
const api_parameter api_parameter_since = {
    "since", API_PARAM_U64, 1, 0x1p53, NULL, "Only changes after this revision."};
const api_parameter api_parameter_drawn = {
    "since",
    API_PARAM_U64,
    1,
    API_MAX_EXACT,
    NULL,
    "The revision of the arrays that the client has: the answer has only the rows that changed "
    "since then. Needs `layout`."};
const api_parameter api_parameter_base_faces = {
    "faces",
    API_PARAM_U64,
    0,
    HE_MAX_ROWS,
    NULL,
    "How many faces the coarsest mesh should have; it has more if it cannot be simplified that "
    "far. Default: 0."};
const api_parameter api_parameter_most_error = {
    "max_error",
    API_PARAM_NUMBER,
    0,
    DBL_MAX,
    NULL,
    "The largest error of the coarsest mesh, measured as the operation decimate measures it. "
    "Default: no limit."};
const api_parameter api_parameter_boundary_weight = {
    "boundary_weight",
    API_PARAM_NUMBER,
    0,
    HE_BOUNDARY_WEIGHT_MAX,
    NULL,
    "Weight of boundary and feature edges relative to faces, as in the operation decimate."};
const api_parameter api_parameter_most_splits = {
    "splits", API_PARAM_U64, 0, HE_MAX_ROWS, NULL, "The largest number of vertex splits to send."};
const api_parameter api_parameter_layout = {
    "layout",
    API_PARAM_U64,
    1,
    API_MAX_EXACT,
    NULL,
    "The layout of the arrays that the client has, from the header of an earlier answer."};
const api_parameter api_parameter_turning = {"cw",
                                             API_PARAM_FLAG,
                                             0,
                                             0,
                                             NULL,
                                             "true: list the elements clockwise. The first element "
                                             "stays first, the others are in reverse order."};
const api_parameter api_parameter_last_seen = {
    "since",
    API_PARAM_TEXT,
    0,
    64,
    NULL,
    "The stream begins after this event, given by its id, or after this revision of the mesh."};
const api_parameter api_parameter_format = {
    "format",
    API_PARAM_CHOICE,
    0,
    0,
    formats,
    "The format of the body. It overrides Content-Type, which may be missing, text/plain or "
    "application/x-www-form-urlencoded."};
const api_parameter api_parameter_format_out = {
    "format",
    API_PARAM_CHOICE,
    0,
    0,
    formats_out,
    "The format of the answer. It overrides Accept. mtl is the material library of obj."};
const api_parameter api_parameter_encoding = {
    "encoding", API_PARAM_CHOICE, 0,
    0,          encodings,        "Text or binary, for formats that have both. Default: binary."};
const api_parameter api_parameter_compress = {
    "compress",
    API_PARAM_CHOICE,
    0,
    0,
    compressions,
    "Compress the buffers of a glb with EXT_meshopt_compression, without loss."};
const api_parameter api_parameter_name = {
    "name", API_PARAM_NAME, 0, ST_MESH_NAME, NULL, "The name of the mesh, if the body is a file."};
const api_parameter api_parameter_repair = {
    "repair",
    API_PARAM_CHOICES,
    0,
    0,
    he_repair_names,
    "Repairs to make if the surface is not a valid mesh, always in this order. weld merges "
    "vertices within the tolerance. drop_degenerate mends faces that use a vertex twice: 1 2 3 3 "
    "becomes the triangle 1 2 3, a face with a keyhole is cut into triangles, and a face with "
    "fewer than three different corners is removed. drop_duplicates removes faces with the same "
    "corners as an earlier face. orient turns faces so that neighbours have the same orientation. "
    "split gives every fan of faces a vertex of its own. fill closes small holes."};
const api_parameter api_parameter_tolerance = {
    "tolerance", API_PARAM_NUMBER,
    0,           DBL_MAX,
    NULL,        "The largest distance between vertices that weld merges. Default: 0."};
const api_parameter api_parameter_hole_edges = {
    "hole_edges",
    API_PARAM_U64,
    3,
    API_MAX_EXACT,
    NULL,
    "The largest number of edges of a hole that fill closes. Default: 16."};
const api_parameter api_parameter_identity = {
    "id",        API_PARAM_TEXT, 0,
    API_MAX_URI, NULL,           "The id for the new mesh. Default: the server chooses one."};
const api_parameter api_parameter_by = {
    "by",        API_PARAM_CHOICE,
    0,           0,
    connections, "What connects two faces: only a shared edge, or also a shared vertex."};

const api_parameter api_parameter_ids = {"ids",       API_PARAM_TEXT, 1,
                                         API_MAX_URI, NULL,           "Ids separated by commas."};
const api_parameter api_parameter_type = {
    "type", API_PARAM_CHOICE, 0,
    0,      api_type_names,   "The type of the numbers, if the body is application/octet-stream."};
const api_parameter api_parameter_type_out = {
    "type",
    API_PARAM_CHOICE,
    0,
    0,
    api_type_names,
    "The type of the numbers in an answer as application/octet-stream: the type of the attribute, "
    "or float for one of doubles, or double for one of floats. Default: the attribute's type."};
const api_parameter api_parameter_type_in = {
    "type",
    API_PARAM_CHOICE,
    0,
    0,
    api_type_names,
    "The type of the numbers, if the body is application/octet-stream: the type of the attribute, "
    "or float for one of doubles, or double for one of floats. Default: the attribute's type."};
const api_parameter api_parameter_components = {
    "components",
    API_PARAM_U64,
    1,
    16,
    NULL,
    "How many numbers one value has, if the body is application/octet-stream. Default: 1."};
const api_parameter api_parameter_meets = {
    "self_intersections", API_PARAM_FLAG, 0, 0, NULL, "true: also look for faces that intersect."};
const api_parameter api_parameter_merge = {
    "merge",
    API_PARAM_NUMBER,
    0,
    DBL_MAX,
    NULL,
    "Vertices no farther apart than this count as being in the same place, edges no longer than "
    "this as having no length, and faces no wider than this as having no area. Default: 1e-9 of "
    "the diagonal of the bounding box of the edges."};
const api_parameter api_parameter_flat = {
    "flat",
    API_PARAM_NUMBER,
    0,
    DBL_MAX,
    NULL,
    "A face with a corner farther than this from its plane counts as not flat. Default: 1e-4 of "
    "the diagonal of the bounding box of the edges."};
const api_parameter api_parameter_small = {
    "small",
    API_PARAM_NUMBER,
    0,
    DBL_MAX,
    NULL,
    "Components count as small if the diagonal of their bounding box is at most this long. "
    "Default: 1e-2 of the diagonal of the bounding box of the edges."};
const api_parameter api_parameter_dry_run = {
    "dry_run",
    API_PARAM_FLAG,
    0,
    0,
    NULL,
    "true: change nothing, and answer as if the change had been made. A body in JSON has "
    "the member `dry_run` instead."};
const api_parameter api_parameter_rule = {
    "rule",
    API_PARAM_CHOICE,
    0,
    0,
    api_rule_names,
    "How edits choose the value of a new element, if the body is application/octet-stream."};
