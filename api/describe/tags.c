#include "api/describe/tags.h"

#include <string.h>

static const struct {
    const char *name, *doc;
} tags[] = {
    {"meshes", "Meshes by id: create, list, rename, replace, copy, delete."},
    {"files", "Meshes as files, and as arrays to draw."},
    {"elements", "Vertices, half-edges, edges and faces, and their neighbours."},
    {"edits", "Edits, lists of edits, undo and redo."},
    {"questions", "Queries, walks, checks, boundaries and components."},
    {"attributes", "Typed values of elements."},
    {"materials", "The table of materials of a mesh."},
    {"events", "Changes of a mesh as server-sent events."},
    {"jobs", "Requests that run as jobs, even after the connection of their client has ended."},
    {"access", "Tokens, tickets, and tasks of an administrator."},
    {"server", "The server itself: health, version, metrics, documentation and the page."},
};

/* The group of a path is the `tag` of the first row with whose `begin` the path begins. */
static const struct {
    const char *begin, *tag;
} beginnings[] = {
    {"/v1/meshes/{mesh}/content", "files"},
    {"/v1/meshes/{mesh}/geometry", "files"},
    {"/v1/meshes/{mesh}/progressive", "files"},
    {"/v1/meshes/{mesh}/vertices", "elements"},
    {"/v1/meshes/{mesh}/halfedges", "elements"},
    {"/v1/meshes/{mesh}/edges", "elements"},
    {"/v1/meshes/{mesh}/faces", "elements"},
    {"/v1/meshes/{mesh}/edits", "edits"},
    {"/v1/meshes/{mesh}/undo", "edits"},
    {"/v1/meshes/{mesh}/redo", "edits"},
    {"/v1/meshes/{mesh}/query", "questions"},
    {"/v1/meshes/{mesh}/traverse", "questions"},
    {"/v1/meshes/{mesh}/check", "questions"},
    {"/v1/meshes/{mesh}/compare", "questions"},
    {"/v1/meshes/{mesh}/boundaries", "questions"},
    {"/v1/meshes/{mesh}/components", "questions"},
    {"/v1/meshes/{mesh}/attributes", "attributes"},
    {"/v1/meshes/{mesh}/materials", "materials"},
    {"/v1/meshes/{mesh}/events", "events"},
    {"/v1/meshes", "meshes"},
    {"/v1/jobs", "jobs"},
    {"/v1/token", "access"},
    {"/v1/tickets", "access"},
    {"/v1/admin", "access"},
    {"/", "server"},
};

const char *api_tag_of(const char *path)
{
    size_t i = 0;
    while (strncmp(path, beginnings[i].begin, strlen(beginnings[i].begin)) != 0) {
        i++; /* not reached: the last row matches every path, because every path begins with "/" */
    }
    return beginnings[i].tag;
}

void api_tags_write(api_out *out)
{
    api_out_key(out, "tags");
    api_out_array_begin(out);
    for (size_t i = 0; i < sizeof tags / sizeof *tags; i++) {
        api_out_object_begin(out);
        api_out_key_string(out, "name", tags[i].name);
        api_out_key_string(out, "description", tags[i].doc);
        api_out_object_end(out);
    }
    api_out_array_end(out);
}
