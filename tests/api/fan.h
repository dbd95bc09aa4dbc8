/* fan.h - a mesh in which many triangles share one vertex, as a request body. If the triangles
 * cross, the search for self-intersections takes a long time. */
#ifndef TESTS_API_FAN_H
#define TESTS_API_FAN_H

#include "tests/api/request.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

typedef struct fan_text {
    char *bytes;
    size_t length, room;
} fan_text;

/* Makes an empty text of at most `room` bytes; the caller must free its bytes. */
fan_text fan_text_new(size_t room);

/* Appends formatted text. */
void fan_add(fan_text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Creates a mesh of one vertex with triangles to `spokes` points on a circle around it; consecutive
 * corners are `stride` points apart, so with a stride above 1 the triangles cross. */
void fan_put(api_bench *b, const char *path, int spokes, int stride);

#endif
