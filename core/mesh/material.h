/* material.h - materials, and the table of them that a mesh has beside its columns.
 *
 * A material is a name and how a surface of it looks, in the terms of glTF 2.0: the base colour
 * (red, green, blue, opacity), how metallic and how rough it is, the light it gives off, and
 * whether faces show on both sides. Numbers are linear and from 0 to 1, but emission, which has no
 * upper end.
 *
 * A face has the material whose name its attribute `material` says: an attribute with labels, of
 * which "" is none. A name without a row in the table is a material of which only the name is
 * known, as in an OBJ file without its library; a row that no face names is one that nothing is
 * made of.
 *
 * Rows never change: an edit puts another in the place of one. They are shared by reference count
 * between copies of a mesh. No two of a table have one name. */
#ifndef HE_MESH_MATERIAL_H
#define HE_MESH_MATERIAL_H

#include "base/status.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { HE_MATERIALS = 4096, HE_MATERIAL_NAME = 1023 }; /* rows of a table, bytes of a name */

typedef struct he_look {
    double base_color[4];
    double metallic, roughness;
    double emission[3];
    bool two_sided;
} he_look;

/* White, neither metallic nor shiny, giving off no light, with one side. */
extern const he_look he_plain_look;

/* Open for reading. */
typedef struct he_material {
    atomic_uint references; /* private */
    uint32_t mark;          /* FNV-1a of the name and the numbers, little-endian: never 0 */
    he_look look;
    size_t length;
    char name[]; /* UTF-8, ends in NUL */
} he_material;

/* One reference. HE_BAD_VALUE for a name that is empty, longer than HE_MATERIAL_NAME, no UTF-8 or
 * has a control character other than a tab, and for a number outside its range; HE_NOT_FINITE;
 * HE_NO_MEMORY. */
HE_NODISCARD he_status he_material_new(const char *name, size_t length, const he_look *look,
                                       he_material **out, he_error *err);
he_material *he_material_retain(he_material *material); /* NULL is passed on */
void he_material_release(he_material *material);
size_t he_material_bytes(const he_material *material); /* 0 for NULL */
/* Have they the same name and numbers? NULL equals NULL alone. */
bool he_material_equal(const he_material *a, const he_material *b);
bool he_look_equal(const he_look *a, const he_look *b);
/* NAME for number 1, else NAME_2 and so on, the name cut where that is too long. */
void he_material_number_name(const char *name, unsigned number, char out[HE_MATERIAL_NAME + 1]);
/* Every number of the look as it may be: what is not finite becomes that of he_plain_look, what is
 * out of range the end of the range. Returns whether one was changed. */
bool he_look_clamp(he_look *look);

/* Slots; NULL where a row was taken out. {0} is empty. */
typedef struct he_materials {
    he_material **rows;
    size_t count, capacity;
} he_materials;

void he_materials_clear(he_materials *materials);
/* Copies the rows with their slots. Fills *out on success only. HE_NO_MEMORY. */
HE_NODISCARD he_status he_materials_copy(const he_materials *materials, he_materials *out,
                                         he_error *err);
/* Copies the rows without the free slots between them. */
HE_NODISCARD he_status he_materials_pack(const he_materials *materials, he_materials *out,
                                         he_error *err);
size_t he_materials_count(const he_materials *materials); /* rows */
size_t he_materials_bytes(const he_materials *materials);
bool he_materials_equal(const he_materials *a,
                        const he_materials *b); /* but for free slots behind */
/* The slot of the row with this name, SIZE_MAX where there is none. */
size_t he_materials_find(const he_materials *materials, const char *name, size_t length);
/* A slot that is free, or the one behind the last. */
size_t he_materials_free_slot(const he_materials *materials);
/* Make room for this many slots. HE_LIMIT beyond HE_MATERIALS, HE_NO_MEMORY. */
HE_NODISCARD he_status he_materials_reserve(he_materials *materials, size_t slots, he_error *err);
/* Add a row, whose name the table has not, in the first free slot. It is the table's from success
 * on. Fails as he_materials_reserve does. */
HE_NODISCARD he_status he_materials_add(he_materials *materials, he_material *takes, he_error *err);

#endif
