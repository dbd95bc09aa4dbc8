/* Runs the fuzz target on each file it is given, as libFuzzer would: the main program of targets
 * that are not linked with libFuzzer. */
#include "fuzz/fuzz.h"

#include <stdio.h>
#include <stdlib.h>

static bool replay(const char *path)
{
    FILE *file = fopen(path, "rb");
    size_t size = 0, capacity = 1 << 16, got;
    uint8_t *bytes = malloc(capacity);
    if (file == NULL || bytes == NULL) {
        perror(path);
        free(bytes);
        return false;
    }
    while ((got = fread(bytes + size, 1, capacity - size, file)) > 0) {
        size += got;
        if (size == capacity) {
            uint8_t *more = realloc(bytes, capacity *= 2);
            if (more == NULL) {
                break;
            }
            bytes = more;
        }
    }
    bool good = ferror(file) == 0 && feof(file) != 0;
    (void)fclose(file);
    /* The block has exactly the size of the file, so that the sanitizer sees a read beyond it. */
    uint8_t *exact = size == 0 ? bytes : realloc(bytes, size);
    if (good && exact != NULL) {
        (void)fprintf(stderr, "%s\n", path);
        (void)LLVMFuzzerTestOneInput(exact, size);
    }
    free(exact);
    return good && exact != NULL;
}

int main(int argc, char **argv)
{
    bool good = argc > 1;
    for (int i = 1; i < argc; i++) {
        good = replay(argv[i]) && good;
    }
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
