#include "giants.h"

#include "build/build.h"

#include <math.h>
#include <stdio.h>

static he_mesh *finish(he_soup *soup, he_status status)
{
    he_mesh *m = NULL;
    if (status == HE_OK) {
        status = he_build(soup, 0, &m, NULL, NULL);
    }
    he_soup_clear(soup);
    return status == HE_OK ? m : NULL;
}

he_mesh *giant_star(void)
{
    enum { CORNERS = 50000 };
    he_soup soup;
    he_soup_init(&soup, NULL);
    he_status status = he_soup_begin_face(&soup, NULL);
    for (uint32_t i = 0; i < CORNERS && status == HE_OK; i++) {
        double angle = 6.283185307179586 * i / CORNERS;
        double radius = i % 2 ? 1 : 0.5;
        he_vec3 p = {radius * cos(angle), radius * sin(angle), 0};
        status = he_soup_add_vertex(&soup, p, NULL);
        if (status == HE_OK) {
            status = he_soup_add_corner(&soup, i, NULL);
        }
    }
    return finish(&soup, status);
}

he_mesh *giant_rows(void)
{
    enum { ROW = 1000 };
    he_soup soup;
    he_soup_init(&soup, NULL);
    he_status status = HE_OK;
    for (uint32_t i = 0; i < 2 * ROW && status == HE_OK; i++) {
        he_vec3 p = {i % ROW, i < ROW ? 0 : 1, 0};
        status = he_soup_add_vertex(&soup, p, NULL);
    }
    for (uint32_t i = 0; i + 1 < ROW && status == HE_OK; i++) {
        const uint32_t lower[3] = {i, i + 1, ROW};
        const uint32_t upper[3] = {ROW + i + 1, ROW + i, ROW - 1};
        status = he_soup_add_face(&soup, lower, 3, NULL);
        if (status == HE_OK) {
            status = he_soup_add_face(&soup, upper, 3, NULL);
        }
    }
    return finish(&soup, status);
}

he_mesh *giant_hub(void)
{
    enum { NEIGHBOURS = 5000 };
    he_soup soup;
    he_soup_init(&soup, NULL);
    he_status status = he_soup_add_vertex(&soup, (he_vec3){0, 0, 0}, NULL);
    for (uint32_t i = 0; i < NEIGHBOURS && status == HE_OK; i++) {
        const double angle = 6.283185307179586 * i / NEIGHBOURS;
        status = he_soup_add_vertex(&soup, (he_vec3){cos(angle), sin(angle), 0}, NULL);
    }
    for (uint32_t i = 0; i < NEIGHBOURS && status == HE_OK; i++) {
        const uint32_t corners[3] = {0, 1 + i, 1 + (i + 1) % NEIGHBOURS};
        status = he_soup_add_face(&soup, corners, 3, NULL);
    }
    return finish(&soup, status);
}

he_mesh *giant_palette(const char *prefix, size_t count)
{
    static const uint32_t triangle[3] = {0, 1, 2};
    he_soup soup;
    he_soup_init(&soup, NULL);
    he_status status = HE_OK;
    for (uint32_t i = 0; i < 3 && status == HE_OK; i++) {
        he_vec3 p = {i == 1, i == 2, 0};
        status = he_soup_add_vertex(&soup, p, NULL);
    }
    if (status == HE_OK) {
        status = he_soup_add_face(&soup, triangle, 3, NULL);
    }
    for (size_t i = 0; i < count && status == HE_OK; i++) {
        char name[40];
        he_material *row = NULL;
        int length = snprintf(name, sizeof name, "%.16s%zu", prefix, i);
        status = he_material_new(name, (size_t)length, &he_plain_look, &row, NULL);
        if (status == HE_OK) {
            status = he_materials_add(&soup.materials, row, NULL);
        }
        if (status != HE_OK) {
            he_material_release(row);
        }
    }
    return finish(&soup, status);
}
