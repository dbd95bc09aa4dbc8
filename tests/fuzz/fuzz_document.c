/* Mesh documents in JSON: read whole and in pieces, they must give the same mesh or the same
 * refusal; the advised repairs must make them acceptable; and a mesh that was read must be written
 * to a document that gives the same mesh again. */
#include "fuzz/fuzz.h"
#include "fuzz/pieces.h"

#include "api/document/document_in.h"
#include "api/document/document_out.h"
#include "mesh/column.h"
#include "unit/fixture.h"
#include "repair/repair.h"

/* Reads a document in pieces. Returns NULL if it is refused. */
static api_document_in *feed(fuzz_pieces pieces, api_problem *problem)
{
    api_document_in *in = api_document_in_new(NULL);
    assert_non_null(in);
    bool good = true;
    char *piece;
    size_t n;
    while (good && (piece = fuzz_pieces_next(&pieces, &n)) != NULL) {
        good = api_document_in_feed(in, piece, n, problem);
        free(piece);
    }
    good = good && api_document_in_end(in, problem);
    FUZZ_REQUIRE(good == (problem->code == HE_OK), "code %d", problem->code);
    if (!good) {
        api_document_in_free(in);
        in = NULL;
    }
    return in;
}

static char *write_document(const he_mesh *mesh, size_t step, size_t *length)
{
    api_document_out *out = api_document_out_new(mesh, "n");
    assert_non_null(out);
    char *text = NULL;
    int64_t got;
    *length = 0;
    do {
        text = realloc(text, *length + step);
        assert_non_null(text);
        got = api_document_out_read(out, text + *length, step);
        *length += got > 0 ? (size_t)got : 0;
    } while (got > 0);
    assert_int_equal(got, 0);
    api_document_out_free(out);
    return text;
}

/* Returns the mesh of a document after a set of repairs, or NULL; then *advised is the set that
 * would help, 0 if none would. */
static he_mesh *make(api_document_in *in, unsigned which, unsigned *advised)
{
    he_repair_plan plan = {.which = which, .hole_edges = 6};
    he_soup *soup = api_document_in_soup(in);
    he_repaired done = {0};
    he_mesh *mesh = NULL;
    api_problem problem = {0};
    *advised = 0;
    if (which != 0 && !api_document_in_lend(in, &problem)) {
        assert_true(problem.code != HE_OK && problem.code != HE_NO_MEMORY);
        return NULL;
    }
    he_status status = he_repair_soup(soup, &plan, &done, NULL);
    if (status == HE_OK) {
        status = he_build(soup, HE_BUILD_TAKE, &mesh, NULL, NULL);
    }
    if (status != HE_OK) {
        assert_int_equal(he_repair_advise(soup, which, advised, NULL), HE_OK);
    } else if (!api_document_in_attributes(in, mesh, he_repaired_soup(&done), &problem)) {
        assert_true(problem.code != HE_OK && problem.code != HE_NO_MEMORY);
        he_mesh_free(mesh);
        mesh = NULL;
    } else {
        assert_int_equal(he_repair_mesh(mesh, &plan, &done, NULL), HE_OK);
        fixture_check(mesh);
    }
    he_repaired_clear(&done);
    return mesh;
}

static bool has_labels(const he_mesh *mesh)
{
    bool has = false;
    for (size_t i = 0; i < he_mesh_columns(mesh); i++) {
        has |= he_mesh_column(mesh, i)->labels != NULL;
    }
    return has;
}

static void write_and_read(const he_mesh *mesh, bool repaired, md_random *random)
{
    size_t length, length_again;
    unsigned advised;
    api_problem problem = {0};
    char *text = write_document(mesh, md_from(random, 1, 5000), &length);
    api_document_in *in = feed((fuzz_pieces){text, length, 1000, random, 0}, &problem);
    FUZZ_REQUIRE(in != NULL, "%s: %s", problem.pointer, problem.detail);
    he_mesh *again = make(in, 0, &advised);
    assert_non_null(again);
    /* he_mesh_equal treats two attributes with labels (names of values) as equal only if they share
     * one table of labels, which a mesh that was read again does not. Such meshes are compared only
     * by their documents. */
    assert_true(repaired || has_labels(mesh) || he_mesh_equal(again, mesh));
    char *repeated = write_document(again, md_from(random, 1, 5000), &length_again);
    assert_int_equal(length_again, length);
    assert_memory_equal(repeated, text, length);
    free(repeated);
    free(text);
    he_mesh_free(again);
    api_document_in_free(in);
}

void fuzz_one(const uint8_t *bytes, size_t size)
{
    static bool ready;
    if (!ready) {
        api_in_setup();
        ready = true;
    }
    md_random random = {fuzz_hash(bytes, size)};
    api_problem problem = {0}, second = {0};
    const char *text = (const char *)bytes;
    api_document_in *in = feed((fuzz_pieces){text, size, 0, &random, 0}, &problem);
    api_document_in *cut =
        feed((fuzz_pieces){text, size, 1u << md_below(&random, 9), &random, 0}, &second);
    bool same = problem.code == second.code && strcmp(problem.detail, second.detail) == 0 &&
                strcmp(problem.pointer, second.pointer) == 0;
    FUZZ_REQUIRE(same, "whole %s: %s, in pieces %s: %s", problem.pointer, problem.detail,
                 second.pointer, second.detail);
    if (in != NULL) {
        unsigned which = md_chance(&random, 50) ? 0 : md_below(&random, 1u << HE_REPAIR_COUNT);
        bool edges = api_document_in_has_edges(in);
        unsigned advised, more;
        he_mesh *mesh = make(in, which, &advised);
        if (advised != 0 && !edges) {
            mesh = make(cut, advised, &more);
            assert_int_equal(more, 0);
        }
        if (mesh != NULL) {
            write_and_read(mesh, (which | advised) != 0, &random);
        }
        he_mesh_free(mesh);
    }
    api_document_in_free(in);
    api_document_in_free(cut);
}
