/* material.h - materials, and the table of them that a mesh has beside its columns.
 *
 * A material has a name and says how a surface looks, in the terms of glTF 2.0: the base colour
 * (red, green, blue, opacity), how metallic and how rough it is, the light it emits, and whether
 * faces show on both sides. Numbers are linear and from 0 to 1, except emission, which has no upper
 * limit.
 *
 * The face attribute `material` names the material of each face: it is an attribute with labels,
 * and the label "" means no material. If the table has no material of a label's name, only the name
 * of that material is known, as in an OBJ file without its library. The table may have materials
 * that no face uses.
 *
 * A material never changes: an edit replaces it by another one. Copies of a mesh share materials by
 * reference count. Names are unique in a table. */
#ifndef HE_MESH_MATERIAL_H
#define HE_MESH_MATERIAL_H

#include "base/status.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    HE_MATERIALS = 4096,
    HE_MATERIAL_NAME = 1023
    /* HE_MATERIALS: the most entries of a table of materials; HE_MATERIAL_NAME: the most bytes of a
     * material's name */
};

typedef struct he_look {
    double base_color[4];
    double metallic, roughness;
    double emission[3];
    bool two_sided;
} he_look;

/* The default look: white, neither metallic nor shiny, no emission, one-sided. */
extern const he_look he_plain_look;

/* A material. Its members never change, and all code may read them. */
typedef struct he_material {
    atomic_uint references; /* private */
    /* Hash (FNV-1a) of the name and of the numbers in `look`, as little-endian bytes; never 0. */
    uint32_t mark;
    he_look look;
    size_t length;
    char name[]; /* UTF-8, ends in NUL */
} he_material;

/* Makes a material with one reference.
 * Returns HE_BAD_VALUE if the name is empty, longer than HE_MATERIAL_NAME, not UTF-8 or has a
 * control character other than a tab, or if a number is outside its range.
 * Returns HE_NOT_FINITE if a number is not finite.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_material_new(const char *name, size_t length, const he_look *look,
                                       he_material **out, he_error *err);
/* Adds a reference to `material`, which may be NULL, and returns it. */
he_material *he_material_retain(he_material *material);
void he_material_release(he_material *material);
size_t he_material_bytes(const he_material *material); /* returns 0 for NULL */
/* Returns true if the names and numbers of two materials are equal. NULL equals only NULL. */
bool he_material_equal(const he_material *a, const he_material *b);
bool he_look_equal(const he_look *a, const he_look *b);
/* Makes a numbered name of a material: writes NAME for number 1, else NAME_2 and so on. A name that
 * is too long is cut. */
void he_material_number_name(const char *name, unsigned number, char out[HE_MATERIAL_NAME + 1]);
/* Brings every number of the look into its range: a number that is not finite becomes the default
 * (he_plain_look), and a number out of range becomes the nearer end of its range. Returns true if a
 * number has changed. */
bool he_look_clamp(he_look *look);

/* A table of materials. Its entries are called slots; a slot is NULL if its material was removed.
 * {0} is an empty table. */
typedef struct he_materials {
    he_material **rows;
    size_t count, capacity;
} he_materials;

void he_materials_clear(he_materials *materials);
/* Copies the materials of a table; each material keeps its slot (its entry of the table).
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_materials_copy(const he_materials *materials, he_materials *out,
                                         he_error *err);
/* Copies the materials of a table without the free slots, so that materials may change
 * their slots. */
HE_NODISCARD he_status he_materials_pack(const he_materials *materials, he_materials *out,
                                         he_error *err);
/* Returns the number of materials of a table; free slots (unused entries) do not count. */
size_t he_materials_count(const he_materials *materials);
size_t he_materials_bytes(const he_materials *materials);
bool he_materials_equal(const he_materials *a,
                        const he_materials *b); /* ignores free slots at the end of a table */
/* Returns the index of the slot of the material with this name, SIZE_MAX if there is none. */
size_t he_materials_find(const he_materials *materials, const char *name, size_t length);
/* Returns the index of the first free slot, or of the slot after the last if no slot is free. */
size_t he_materials_free_slot(const he_materials *materials);
/* Allocates memory for a table of `slots` slots in all.
 * Returns HE_LIMIT if that is more than HE_MATERIALS.
 * Returns HE_NO_MEMORY if memory is out. */
HE_NODISCARD he_status he_materials_reserve(he_materials *materials, size_t slots, he_error *err);
/* Puts a material into the first free slot of a table. No material of the table may have its name.
 * On success the table owns the material. Fails as he_materials_reserve does. */
HE_NODISCARD he_status he_materials_add(he_materials *materials, he_material *takes, he_error *err);

#endif
