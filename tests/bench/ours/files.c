/* Benchmark rows: the daemon's readers and writers of mesh files, with files given in pieces of 64
 * kB. */
#include "bench/ours/ours.h"
#include "mesh/walk.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PIECE = 65536 };

/* Reports the counts of a mesh and the sum of its coordinates, which show whether two readers have
 * read the same mesh. */
static void describe(const he_mesh *m, bench_result *out)
{
    double sum = 0;
    for (uint32_t v = 0; v < he_mesh_issued(m, HE_VERTEX); v++) {
        he_vec3 p = he_position(m, (he_vertex){v});
        sum += fabs(p.x) + 2 * fabs(p.y) + 3 * fabs(p.z);
    }
    out->amount = he_mesh_faces(m);
    bench_exact(out, bench_counts(0, he_mesh_vertices(m), he_mesh_edges(m), he_mesh_faces(m)));
    bench_near(out, sum);
}

void bench_read(const bench_side *side, const char *format, const char *name, he_import *out)
{
    he_reader *reader;
    char *piece = malloc(PIECE);
    FILE *file = bench_open(side, name, "rb");
    bench_require(he_reader_new(he_format_find(format), NULL, &reader, NULL));
    size_t n;
    while ((n = fread(piece, 1, PIECE, file)) > 0) {
        bench_require(he_reader_feed(reader, piece, n, NULL));
    }
    bench_require(he_reader_finish(reader, out, NULL));
    he_reader_free(reader);
    fclose(file);
    free(piece);
}

static he_mesh *read_mesh(const bench_side *side, const char *format, const char *name)
{
    he_import import;
    he_mesh *mesh;
    bench_read(side, format, name, &import);
    bench_require(he_build(&import.soup, HE_BUILD_TAKE, &mesh, NULL, NULL));
    he_import_clear(&import);
    return mesh;
}

void bench_write(const bench_side *side, const he_mesh *m, const char *format, const char *encoding,
                 const char *name)
{
    he_writer *writer;
    const he_format *row = he_format_find(format);
    int number = he_format_encoding(row, encoding);
    char *piece = malloc(PIECE);
    FILE *file = bench_open(side, name, "wb");
    bench_require(he_writer_new(row, m, number < 0 ? 0 : (size_t)number, NULL, &writer, NULL));
    size_t n;
    while ((n = he_writer_read(writer, piece, PIECE)) > 0) {
        if (fwrite(piece, 1, n, file) != n) {
            fprintf(stderr, "%s cannot be written\n", name);
            exit(1);
        }
    }
    he_writer_free(writer);
    fclose(file);
    free(piece);
}

void bench_write_positions(const bench_side *side, const char *name, const he_mesh *m,
                           uint32_t first)
{
    FILE *file = bench_open(side, name, "wb");
    for (uint32_t v = first; v < he_mesh_issued(m, HE_VERTEX); v++) {
        const he_vec3 p = he_position(m, (he_vertex){v});
        const double c[3] = {p.x, p.y, p.z};
        if (fwrite(c, sizeof c, 1, file) != 1) {
            bench_require(HE_NO_MEMORY);
        }
    }
    (void)fclose(file);
}

static void import(bench_side *side, const char *format, const char *name, bench_result *out)
{
    double start = bench_seconds();
    he_mesh *mesh = read_mesh(side, format, name);
    out->value = bench_seconds() - start;
    describe(mesh, out);
    he_mesh_free(mesh);
}

/* Measures the export of a mesh; our reader then reads the file, as it reads the files that the
 * other programs wrote. */
static void export(bench_side *side, const char *format, const char *encoding, const char *name,
                   bench_result *out)
{
    const he_mesh *m = bench_mesh(side);
    double start = bench_seconds();
    bench_write(side, m, format, encoding, name);
    out->value = bench_seconds() - start;
    describe(m, out);
    out->has_exact = out->has_near = false;
}

static void import_glb(bench_side *side, bench_result *out)
{
    import(side, "glb", "input.glb", out);
}
static void import_obj(bench_side *side, bench_result *out)
{
    import(side, "obj", "input.obj", out);
}
static void import_off(bench_side *side, bench_result *out)
{
    import(side, "off", "input.off", out);
}
static void import_ply(bench_side *side, bench_result *out)
{
    import(side, "ply", "input.ply", out);
}
static void import_stl(bench_side *side, bench_result *out)
{
    import(side, "stl", "input.stl", out);
}
static void export_glb(bench_side *side, bench_result *out)
{
    export(side, "glb", "", "output.glb", out);
}
static void export_off(bench_side *side, bench_result *out)
{
    export(side, "off", "", "output.off", out);
}
static void export_stl(bench_side *side, bench_result *out)
{
    export(side, "stl", "binary", "output.stl", out);
}
static void export_obj(bench_side *side, bench_result *out)
{
    export(side, "obj", "", "output.obj", out);
}
static void export_ply(bench_side *side, bench_result *out)
{
    export(side, "ply", "binary", "output.ply", out);
}

/* Reads the OBJ file that a program has just exported, and reports its counts. */
static void check_obj(bench_side *side, bench_result *out)
{
    import(side, "obj", "output.obj", out);
}
static void check_ply(bench_side *side, bench_result *out)
{
    import(side, "ply", "output.ply", out);
}

static void write_float(FILE *file, double value)
{
    float narrow = (float)value;
    fwrite(&narrow, sizeof narrow, 1, file);
}

/* A format of text: the file's name and first lines, the words in front of a vertex and of a face,
 * and the number of the first vertex. */
typedef struct text_format {
    const char *name, *head, *vertex, *face;
    uint32_t base;
} text_format;

static void write_text(const bench_side *side, const text_format *format)
{
    const uint32_t base = format->base;
    const bench_input *in = &side->input;
    FILE *file = bench_open(side, format->name, "wb");
    setvbuf(file, NULL, _IOFBF, PIECE);
    fputs(format->head, file);
    for (uint32_t v = 0; v < in->vertices; v++) {
        const double *p = in->positions + 3 * (size_t)v;
        fprintf(file, "%s%.9g %.9g %.9g\n", format->vertex, p[0], p[1], p[2]);
    }
    for (uint32_t f = 0; f < in->faces; f++) {
        const uint32_t *c = in->corners + in->starts[f];
        fprintf(file, "%s %u %u %u\n", format->face, c[0] + base, c[1] + base, c[2] + base);
    }
    fclose(file);
}

static void write_ply(const bench_side *side)
{
    const bench_input *in = &side->input;
    FILE *file = bench_open(side, "input.ply", "wb");
    setvbuf(file, NULL, _IOFBF, PIECE);
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\nelement vertex %u\nproperty float x\n"
            "property float y\nproperty float z\nelement face %u\n"
            "property list uchar int vertex_indices\nend_header\n",
            in->vertices, in->faces);
    for (size_t i = 0; i < 3 * (size_t)in->vertices; i++) {
        write_float(file, in->positions[i]);
    }
    for (uint32_t f = 0; f < in->faces; f++) {
        fputc(3, file);
        fwrite(in->corners + in->starts[f], sizeof(uint32_t), 3, file);
    }
    fclose(file);
}

static void write_stl(const bench_side *side)
{
    const bench_input *in = &side->input;
    char head[80] = "bench";
    FILE *file = bench_open(side, "input.stl", "wb");
    setvbuf(file, NULL, _IOFBF, PIECE);
    fwrite(head, sizeof head, 1, file);
    fwrite(&in->faces, sizeof in->faces, 1, file);
    for (uint32_t f = 0; f < in->faces; f++) {
        for (int i = 0; i < 3; i++) {
            write_float(file, 0);
        }
        for (int k = 0; k < 3; k++) {
            for (int i = 0; i < 3; i++) {
                write_float(
                    file, in->positions[3 * (size_t)in->corners[3 * f + (uint32_t)k] + (size_t)i]);
            }
        }
        fputc(0, file);
        fputc(0, file);
    }
    fclose(file);
}

/* Writes the files that all programs read, with the C library's functions, so that no program reads
 * a file that it wrote itself. */
static void make_files(bench_side *side, bench_result *out)
{
    char head[64];
    write_text(side, &(text_format){"input.obj", "", "v ", "f", 1});
    snprintf(head, sizeof head, "OFF\n%u %u 0\n", side->input.vertices, side->input.faces);
    write_text(side, &(text_format){"input.off", head, "", "3", 0});
    write_ply(side);
    write_stl(side);
    out->amount = side->input.faces;
}

/* Writes a binary glTF, which only our program reads. */
static void make_glb(bench_side *side, bench_result *out)
{
    bench_write(side, bench_mesh(side), "glb", "", "input.glb");
    out->amount = side->input.faces;
}

const bench_row bench_file_rows[] = {
    {"make_files", make_files}, {"import_obj", import_obj}, {"import_off", import_off},
    {"import_ply", import_ply}, {"import_stl", import_stl}, {"export_obj", export_obj},
    {"export_ply", export_ply}, {"check_obj", check_obj},   {"check_ply", check_ply},
    {"make_glb", make_glb},     {"import_glb", import_glb}, {"export_glb", export_glb},
    {"export_off", export_off}, {"export_stl", export_stl}, {NULL, NULL}};
