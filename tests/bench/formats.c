/* Writing and reading mesh files in memory, a torus of about a million triangles, in pieces of 64
 * kB as the daemon moves them. Processor time, the best of ROUNDS runs.
 *
 *     build/tests/bench/formats [ROUNDS]                                                       */
#include "format/format.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SIDE = 724, PIECE = 65536, MOST_ROUNDS = 99 };

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void require(he_status status)
{
    if (status != HE_OK) {
        fprintf(stderr, "%s\n", he_status_title(status));
        exit(1);
    }
}

static he_mesh *torus(void)
{
    he_soup soup;
    he_mesh *mesh;
    he_soup_init(&soup, NULL);
    for (uint32_t i = 0; i < SIDE; i++) {
        for (uint32_t j = 0; j < SIDE; j++) {
            double a = 6.283185307179586 * i / SIDE, b = 6.283185307179586 * j / SIDE;
            double r = 3 + cos(b) + 0.1 * sin(9 * a);
            float x = (float)(r * cos(a)), y = (float)(r * sin(a)), z = (float)sin(b);
            require(he_soup_add_vertex(&soup, (he_vec3){(double)x, (double)y, (double)z}, NULL));
        }
    }
    for (uint32_t i = 0; i < SIDE; i++) {
        for (uint32_t j = 0; j < SIDE; j++) {
            uint32_t down = (i + 1) % SIDE * SIDE, right = (j + 1) % SIDE;
            uint32_t a = i * SIDE + j, b = down + j, c = down + right, d = i * SIDE + right;
            require(he_soup_add_face(&soup, (uint32_t[3]){a, b, c}, 3, NULL));
            require(he_soup_add_face(&soup, (uint32_t[3]){a, c, d}, 3, NULL));
        }
    }
    require(he_build(&soup, HE_BUILD_TAKE, &mesh, NULL, NULL));
    he_soup_clear(&soup);
    return mesh;
}

static size_t write_once(const he_format *format, size_t encoding, const he_mesh *mesh, char *bytes,
                         size_t room)
{
    he_writer *writer;
    size_t length = 0, n;
    require(he_writer_new(format, mesh, encoding, &writer, NULL));
    while (room - length >= PIECE && (n = he_writer_read(writer, bytes + length, PIECE)) > 0) {
        length += n;
    }
    he_writer_free(writer);
    return length;
}

static void read_once(const he_format *format, const char *bytes, size_t length)
{
    he_reader *reader;
    he_import import;
    require(he_reader_new(format, NULL, &reader, NULL));
    for (size_t at = 0; at < length; at += PIECE) {
        size_t n = length - at < PIECE ? length - at : PIECE;
        require(he_reader_feed(reader, bytes + at, n, NULL));
    }
    require(he_reader_finish(reader, &import, NULL));
    he_reader_free(reader);
    he_import_clear(&import);
}

int main(int argc, char **argv)
{
    int rounds = argc > 1 ? (int)strtol(argv[1], NULL, 10) : 3;
    he_mesh *mesh = torus();
    size_t room = (size_t)400 << 20;
    char *bytes = malloc(room);
    if (bytes == NULL || rounds < 1 || rounds > MOST_ROUNDS) {
        return 1;
    }
    double faces = he_mesh_faces(mesh) / 1e6;
    const he_format *format;
    for (size_t i = 0; (format = he_format_at(i)) != NULL; i++) {
        for (size_t k = 0; format->encodings[k] != NULL; k++) {
            double write = 1e9, read = 1e9;
            size_t length = 0;
            for (int round = 0; round < rounds; round++) {
                double start = seconds();
                length = write_once(format, k, mesh, bytes, room);
                double middle = seconds();
                read_once(format, bytes, length);
                double end = seconds();
                write = fmin(write, middle - start);
                read = fmin(read, end - middle);
            }
            printf("%s %-18s %4zu MB   write %5.1f Mface/s   read %5.1f Mface/s\n", format->name,
                   format->encodings[k], length / 1000000, faces / write, faces / read);
        }
    }
    free(bytes);
    he_mesh_free(mesh);
    return 0;
}
