#include "api/describe/parameters.h"

#include "algo/decimate.h"
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
    "limit", API_PARAM_U64, 1, API_MAX_PAGE, NULL, "How many items a page has at most."};
const api_parameter api_parameter_cursor = {
    "cursor", API_PARAM_TEXT, 0, API_MAX_URI, NULL, "Where to go on: `next` of the page before."};
const api_parameter api_parameter_revision = {
    "revision", API_PARAM_U64, 1,
    0x1p53,     NULL,          "An earlier revision that the history still holds."};
const api_parameter api_parameter_since = {
    "since", API_PARAM_U64, 1, 0x1p53, NULL, "Only what came after this revision."};
const api_parameter api_parameter_drawn = {
    "since", API_PARAM_U64,
    1,       API_MAX_EXACT,
    NULL,    "The revision of the arrays there are: send what changed. With `layout`."};
const api_parameter api_parameter_base_faces = {
    "faces", API_PARAM_U64,
    0,       HE_MAX_ROWS,
    NULL,    "Faces of the base, or more where that few cannot be had; 0 when not given."};
const api_parameter api_parameter_most_error = {
    "max_error", API_PARAM_NUMBER,
    0,           DBL_MAX,
    NULL,        "Of the base, as decimate means it; no limit if not said."};
const api_parameter api_parameter_boundary_weight = {
    "boundary_weight",
    API_PARAM_NUMBER,
    0,
    HE_BOUNDARY_WEIGHT_MAX,
    NULL,
    "As decimate means it; its default if not said."};
const api_parameter api_parameter_most_splits = {
    "splits", API_PARAM_U64, 0, HE_MAX_ROWS, NULL, "Send no more vertex splits than these."};
const api_parameter api_parameter_layout = {
    "layout", API_PARAM_U64, 1, API_MAX_EXACT, NULL, "The layout of the arrays there are."};
const api_parameter api_parameter_turning = {
    "cw", API_PARAM_FLAG, 0,
    0,    NULL,           "Clockwise: the same first element, then the rest backwards."};
const api_parameter api_parameter_last_seen = {
    "since", API_PARAM_TEXT, 0, 64, NULL, "Go on after this: an event's id, or a revision."};
const api_parameter api_parameter_format = {
    "format",
    API_PARAM_CHOICE,
    0,
    0,
    formats,
    "The format of the body, instead of its Content-Type, which may then be missing, text/plain or "
    "application/x-www-form-urlencoded."};
const api_parameter api_parameter_format_out = {
    "format",    API_PARAM_CHOICE,
    0,           0,
    formats_out, "The format, instead of Accept; mtl is the material library of obj."};
const api_parameter api_parameter_encoding = {
    "encoding", API_PARAM_CHOICE, 0,
    0,          encodings,        "Text or binary, where a format has both; binary if not said."};
const api_parameter api_parameter_compress = {
    "compress",
    API_PARAM_CHOICE,
    0,
    0,
    compressions,
    "Compresses the buffers of a glb with EXT_meshopt_compression, without loss."};
const api_parameter api_parameter_name = {
    "name", API_PARAM_TEXT, 0, ST_MESH_NAME, NULL, "Name of the mesh, where the body is a file."};
const api_parameter api_parameter_repair = {
    "repair",
    API_PARAM_CHOICES,
    0,
    0,
    he_repair_names,
    "Repairs of a surface that is no mesh, made in this order, whatever the order here. weld "
    "merges vertices within the tolerance; drop_degenerate mends faces that repeat a vertex: 1 2 3 "
    "3 becomes the triangle 1 2 3, a face with a keyhole is cut into triangles, and a face with "
    "fewer than three different corners is left out; "
    "drop_duplicates leaves out faces with the corners of an earlier face; "
    "orient turns faces so that neighbours agree; split gives every fan of faces a vertex of its "
    "own; fill closes small holes."};
const api_parameter api_parameter_tolerance = {
    "tolerance", API_PARAM_NUMBER,
    0,           DBL_MAX,
    NULL,        "How far apart vertices may be that weld merges; 0 if not said."};
const api_parameter api_parameter_hole_edges = {
    "hole_edges",  API_PARAM_U64, 3,
    API_MAX_EXACT, NULL,          "The most edges of a hole that fill closes; 16 if not said."};
const api_parameter api_parameter_identity = {
    "id",        API_PARAM_TEXT, 0,
    API_MAX_URI, NULL,           "Id of the mesh to be made; the server chooses without."};
const api_parameter api_parameter_by = {
    "by", API_PARAM_CHOICE, 0,
    0,    connections,      "Faces are connected across edges, or already by a shared vertex."};

const api_parameter api_parameter_ids = {"ids",       API_PARAM_TEXT, 1,
                                         API_MAX_URI, NULL,           "Ids joined by commas."};
const api_parameter api_parameter_type = {
    "type", API_PARAM_CHOICE, 0,
    0,      api_type_names,   "Type of the numbers, where the body is octets."};
const api_parameter api_parameter_components = {
    "components", API_PARAM_U64, 1,
    16,           NULL,          "Numbers of one value, where the body is octets; 1 if not said."};
const api_parameter api_parameter_meets = {"self_intersections",
                                           API_PARAM_FLAG,
                                           0,
                                           0,
                                           NULL,
                                           "Look for faces that meet where they should not, too."};
const api_parameter api_parameter_merge = {
    "merge",
    API_PARAM_NUMBER,
    0,
    DBL_MAX,
    NULL,
    "Vertices no farther apart are in one place, edges no longer have no length, faces no wider "
    "have no area; 1e-9 of the diagonal of the box around the edges if not said."};
const api_parameter api_parameter_flat = {
    "flat",
    API_PARAM_NUMBER,
    0,
    DBL_MAX,
    NULL,
    "A corner farther from the plane of its face makes that nonplanar; 1e-4 of the diagonal of "
    "the box around the edges if not said."};
const api_parameter api_parameter_small = {
    "small",
    API_PARAM_NUMBER,
    0,
    DBL_MAX,
    NULL,
    "Components in boxes whose diagonal is no longer are small; 1e-2 of the diagonal of the "
    "box around the edges if not said."};
const api_parameter api_parameter_dry_run = {
    "dry_run", API_PARAM_FLAG, 0, 0, NULL, "Do nothing, and answer as if; members say it in JSON."};
const api_parameter api_parameter_rule = {
    "rule", API_PARAM_CHOICE, 0,
    0,      api_rule_names,   "What edits give to new elements, where the body is octets."};
