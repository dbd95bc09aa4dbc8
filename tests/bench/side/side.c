#include "bench/side/side.h"

#include <malloc.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <time.h>

/* The quantity that a row measures. A row's work is between two calls of bench_seconds, so these
 * calls also read the memory if that is measured. */
typedef enum measure { TIME, HEAP, PEAK } measure;

static struct {
    measure by;
    bool began;
    size_t before, after; /* bytes of memory at the first and at the second call of bench_seconds */
    struct rusage first, last;
} meter;

static size_t heap_bytes(void)
{
    struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

/* Returns the number in a line of /proc/self/status, in bytes. */
static size_t status_bytes(const char *name)
{
    char line[256];
    size_t bytes = 0, length = strlen(name);
    FILE *file = fopen("/proc/self/status", "r");
    while (file != NULL && bytes == 0 && fgets(line, sizeof line, file) != NULL) {
        if (strncmp(line, name, length) == 0) {
            bytes = 1024 * (size_t)strtoul(line + length, NULL, 10);
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    return bytes;
}

/* Resets the peak of resident memory. */
static void reset_peak(void)
{
    FILE *file = fopen("/proc/self/clear_refs", "w");
    if (file == NULL || fputs("5", file) == EOF || fclose(file) != 0) {
        fprintf(stderr, "the peak of memory cannot be reset here\n");
        exit(1);
    }
}

static size_t metered(void)
{
    if (meter.by == HEAP) {
        return heap_bytes();
    }
    return meter.by == PEAK ? status_bytes(meter.began ? "VmHWM:" : "VmRSS:") : 0;
}

static void read_meters(void)
{
    if (meter.began) {
        meter.after = metered();
        getrusage(RUSAGE_SELF, &meter.last);
    } else {
        if (meter.by == PEAK) {
            reset_peak();
        }
        meter.before = metered();
        getrusage(RUSAGE_SELF, &meter.first);
        meter.began = true;
    }
}

/* Returns the time that the kernel of the operating system has spent for this program. */
static double system_seconds(void)
{
    const struct timeval *from = &meter.first.ru_stime, *to = &meter.last.ru_stime;
    return (double)(to->tv_sec - from->tv_sec) + 1e-6 * (double)(to->tv_usec - from->tv_usec);
}

double bench_seconds(void)
{
    struct timespec now;
    read_meters();
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double bench_remesh_length(const bench_side *side)
{
    /* the area of the torus, and that of a regular triangle with sides of length 1 */
    const double area = 119.861, regular = 0.4330127018922193;
    return sqrt(area / (regular * side->input.faces));
}

bench_part bench_deform_part(const bench_side *side, uint32_t vertex)
{
    /* the torus is 8 wide */
    const double x = side->input.positions[3 * (size_t)vertex];
    return x > 3.2 ? BENCH_HANDLE : x < -3.2 ? BENCH_FIXED : BENCH_FREE;
}

void bench_deform_goal(const bench_side *side, uint32_t vertex, double to[3])
{
    const double *p = side->input.positions + 3 * (size_t)vertex;
    const double angle = 0.8, lift = 1, c = cos(angle), s = sin(angle);
    to[0] = c * p[0] - s * p[2];
    to[1] = p[1];
    to[2] = s * p[0] + c * p[2] + lift;
}

bool bench_in_cap(const bench_side *side, uint32_t vertex, bool left)
{
    const double x = side->input.positions[3 * (size_t)vertex];
    return (left ? -x : x) > 3.9;
}

void bench_bend(double point[3])
{
    const double wave = sin(3 * point[0] + 5 * point[1] + 7 * point[2]);
    for (int k = 0; k < 3; k++) {
        point[k] += 0.02 * (k + 1) * wave;
    }
}

void bench_path(const bench_side *side, const char *name, char *path, size_t size)
{
    snprintf(path, size, "%s/%s", side->folder, name);
}

FILE *bench_open(const bench_side *side, const char *name, const char *mode)
{
    char path[512];
    bench_path(side, name, path, sizeof path);
    FILE *file = fopen(path, mode);
    if (file == NULL) {
        fprintf(stderr, "%s cannot be opened\n", path);
        exit(1);
    }
    return file;
}

void bench_exact(bench_result *out, uint64_t exact)
{
    out->exact = exact;
    out->has_exact = true;
}

void bench_near(bench_result *out, double near)
{
    out->near = near;
    out->has_near = true;
}

uint64_t bench_counts(uint64_t faces_hash, uint64_t vertices, uint64_t edges, uint64_t faces)
{
    const uint64_t odd = 0x9E3779B97F4A7C15u;
    return ((faces_hash * odd + vertices) * odd + edges) * odd + faces;
}

static const bench_row *find(const bench_row *const *tables, const char *name)
{
    for (; *tables != NULL; tables++) {
        for (const bench_row *row = *tables; row->name != NULL; row++) {
            if (strcmp(row->name, name) == 0) {
                return row;
            }
        }
    }
    return NULL;
}

/* Returns the name of the row in an input line, and sets the quantity to be measured if the line
 * begins with one. */
static const char *set_meter(const char *line)
{
    memset(&meter, 0, sizeof meter);
    if (strncmp(line, "heap ", 5) == 0 || strncmp(line, "peak ", 5) == 0) {
        meter.by = line[0] == 'h' ? HEAP : PEAK;
        return line + 5;
    }
    return line;
}

static void answer(const bench_row *row, bench_side *side)
{
    bench_result result = {0};
    if (row == NULL) {
        printf("unknown\n");
        return;
    }
    row->run(side, &result);
    if (meter.by != TIME) {
        result.value = (double)meter.after - (double)meter.before;
    }
    printf("%.9g %.17g ", result.value, result.amount);
    if (result.has_exact) {
        printf("%016llx ", (unsigned long long)result.exact);
    } else {
        printf("- ");
    }
    if (result.has_near) {
        printf("%.17g", result.near);
    } else {
        printf("-");
    }
    printf(" %.6f %ld\n", system_seconds(), meter.last.ru_minflt - meter.first.ru_minflt);
}

int bench_serve(int argc, char **argv, const bench_row *const *tables)
{
    char line[64];
    bench_side side = {0};
    if (argc != 5) {
        fprintf(stderr, "usage: %s INPUT natural|shuffled SIDE FOLDER\n", argv[0]);
        return 2;
    }
    if (getenv("BENCH_SMALL_PAGES") != NULL) {
        prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
    }
    bench_input_make(argv[1], strcmp(argv[2], "shuffled") == 0,
                     (uint32_t)strtoul(argv[3], NULL, 10), &side.input);
    side.folder = argv[4];
    while (fgets(line, sizeof line, stdin) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        answer(find(tables, set_meter(line)), &side);
        fflush(stdout);
    }
    return 0;
}
