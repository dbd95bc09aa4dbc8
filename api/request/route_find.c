/* route_find.c - finds the row of the table of routes that answers a request, and parses its
 * parameters. */
#include "api/request/route.h"

#include "base/mem.h"

#include <assert.h>
#include <string.h>

bool api_choices_parse(const char *const *choices, const char *list, unsigned *out)
{
    *out = 0;
    for (const char *at = list;; at++) {
        size_t length = strcspn(at, ","), i = 0;
        while (choices[i] != NULL &&
               (strlen(choices[i]) != length || memcmp(choices[i], at, length) != 0)) {
            i++;
        }
        if (choices[i] == NULL || (*out >> i & 1) != 0) {
            return false;
        }
        *out |= 1u << i;
        at += length;
        if (*at == '\0') {
            return true;
        }
    }
}

/* --- the tree of templates --- */

/* The maximum number of rows that have equal paths and differ in the method. */
enum { MOST_METHODS = 5 };

/* One segment of path templates; its parent is the segment before it. The children of a node are
 * either different literal segments or a single variable. */
typedef struct node {
    const char *segment; /* points into a template; ends at a slash or at the end of the text */
    size_t length;
    struct node *child, *sibling; /* first child, next sibling */
    /* Rows whose template ends with this segment; ends in NULL. */
    const api_route *rows[MOST_METHODS + 1];
} node;

struct api_route_tree {
    size_t count;
    node nodes[]; /* nodes[0] is the root, before the first segment */
};

static bool is_variable(const node *n)
{
    return n->segment[0] == '{';
}

/* Returns the first letter of a variable's name, which differs for each variable; 0 for a literal
 * segment. */
static char letter_of(const node *n)
{
    return is_variable(n) ? n->segment[1] : '\0';
}

static bool is_literal(const node *n, const char *text, size_t length)
{
    return n->length == length && memcmp(n->segment, text, length) == 0;
}

/* Returns the child of `parent` with this segment; adds it if it is missing. */
static node *find_or_add(api_route_tree *tree, node *parent, const char *segment)
{
    size_t length = strcspn(segment, "/");
    node **last = &parent->child;
    while (*last != NULL && !is_literal(*last, segment, length)) {
        assert(!is_variable(*last) && segment[0] != '{');
        last = &(*last)->sibling;
    }
    if (*last == NULL) {
        *last = &tree->nodes[tree->count++];
        (*last)->segment = segment;
        (*last)->length = length;
    }
    return *last;
}

static void add_row(api_route_tree *tree, const api_route *row)
{
    node *at = &tree->nodes[0];
    const char *slash = row->path;
    while (slash != NULL && slash[1] != '\0') {
        at = find_or_add(tree, at, slash + 1);
        slash = strchr(slash + 1, '/');
    }
    size_t i = 0;
    while (at->rows[i] != NULL) {
        i++;
    }
    assert(i < MOST_METHODS);
    at->rows[i] = row;
}

api_route_tree *api_route_tree_new(api_route_table table)
{
    size_t most = 1;
    for (size_t i = 0; i < table.count; i++) {
        for (const char *at = table.rows[i].path; *at != '\0'; at++) {
            most += *at == '/';
        }
    }
    api_route_tree *tree = he_mem_zero(1, sizeof *tree + most * sizeof(node));
    if (tree == NULL) {
        return NULL;
    }
    tree->count = 1;
    tree->nodes[0].segment = "";
    for (size_t i = 0; i < table.count; i++) {
        add_row(tree, &table.rows[i]);
    }
    return tree;
}

void api_route_tree_free(api_route_tree *tree)
{
    he_mem_free(tree);
}

/* --- matching a path --- */

static bool take_variable(const node *n, const char *segment, api_variables *out)
{
    switch (letter_of(n)) {
    case 'm':
        out->mesh = segment;
        return true;
    case 'i':
        out->id = segment;
        return true;
    case 'c':
        out->code = segment;
        return true;
    case 'j':
        out->job = segment;
        return true;
    case 'n':
        out->name = segment;
        return true;
    case 'r':
        out->revision = segment;
        return true;
    case 'a':
        return true;
    default: /* {domain} */
        for (he_kind kind = HE_VERTEX; kind <= HE_MESH_KIND; kind++) {
            if (strcmp(segment, he_kind_plural(kind)) == 0) {
                out->domain = kind;
                return true;
            }
        }
        return false;
    }
}

/* Returns the child of `n` that matches a segment of the path, or NULL. */
static const node *step(const node *n, const char *segment, api_variables *out)
{
    size_t length = strlen(segment);
    const node *child = n->child;
    if (child != NULL && is_variable(child)) {
        return take_variable(child, segment, out) ? child : NULL;
    }
    while (child != NULL && !is_literal(child, segment, length)) {
        child = child->sibling;
    }
    return child;
}

/* Follows the path down the tree as far as templates match; `*taken` gets the number of
 * segments. */
static const node *walk(const api_route_tree *tree, const api_path *path, api_variables *out,
                        size_t *taken)
{
    const node *n = &tree->nodes[0];
    *out = (api_variables){.domain = HE_KIND_COUNT};
    for (*taken = 0; *taken < path->count; ++*taken) {
        const node *next = step(n, path->segments[*taken], out);
        if (next == NULL) {
            return n;
        }
        n = next;
        if (letter_of(n) == 'a') { /* {asset} matches the rest of the path */
            *taken = path->count;
            return n;
        }
    }
    return n;
}

static void add_word(char *list, size_t size, const char *word, size_t length)
{
    size_t used = strlen(list), comma = used > 0 ? 2 : 0;
    if (used + comma + length < size) {
        memcpy(list + used, ", ", comma);
        memcpy(list + used + comma, word, length);
        list[used + comma + length] = '\0';
    }
}

static void list_methods(const node *n, char allow[API_ALLOW])
{
    for (const api_route *const *row = n->rows; *row != NULL; row++) {
        const char *method = (*row)->method;
        add_word(allow, API_ALLOW, method, strlen(method));
        if (strcmp(method, "GET") == 0) {
            add_word(allow, API_ALLOW, "HEAD", 4);
        }
    }
    if (allow[0] != '\0') {
        add_word(allow, API_ALLOW, "OPTIONS", 7);
    }
}

const api_route *api_route_find(const api_route_tree *tree, const char *method,
                                const api_path *path, api_variables *out, char allow[API_ALLOW])
{
    size_t taken;
    const char *wanted = strcmp(method, "HEAD") == 0 ? "GET" : method;
    const node *n = walk(tree, path, out, &taken);
    allow[0] = '\0';
    /* The value of {name}, an attribute's name, is the only one that may contain a slash. */
    if (taken < path->count || (path->has_slash && letter_of(n) != 'n')) {
        return NULL;
    }
    for (const api_route *const *row = n->rows; *row != NULL; row++) {
        if (strcmp((*row)->method, wanted) == 0) {
            return *row;
        }
    }
    list_methods(n, allow);
    return NULL;
}

const char *api_route_choices(const api_route_tree *tree, const api_path *path,
                              char list[API_CHOICES])
{
    size_t taken;
    api_variables unused;
    const node *n = walk(tree, path, &unused, &taken);
    list[0] = '\0';
    for (const node *child = n->child; child != NULL; child = child->sibling) {
        if (!is_variable(child)) {
            add_word(list, API_CHOICES, child->segment, child->length);
        } else if (letter_of(child) == 'd') {
            for (he_kind kind = HE_VERTEX; kind <= HE_MESH_KIND; kind++) {
                const char *domain = he_kind_plural(kind);
                add_word(list, API_CHOICES, domain, strlen(domain));
            }
        }
    }
    return taken < path->count ? path->segments[taken] : NULL;
}
