/* sorted_cursor.h - the cursor with which a client requests the next page of a sorted list of
 * meshes. It names the order, and the place of the last mesh that the server has looked at: the
 * member by which the list is sorted, and the id. So the next page begins at the right place even
 * if that mesh was renamed, changed or deleted in the meantime. */
#ifndef HE_API_HEADER_SORTED_CURSOR_H
#define HE_API_HEADER_SORTED_CURSOR_H

#include "api/json/problem.h"
#include "journal/record.h"

/* The most bytes of a cursor: the order, the longest name in hexadecimal digits, and the id. */
enum { API_SORTED_CURSOR = 16 + 2 * ST_MESH_NAME + ST_MESH_ID };

/* The names of the orders in requests, by st_card_order; ended by NULL. */
extern const char *const api_order_names[];

void api_sorted_cursor_write(st_card_order order, const st_card *last, char out[API_SORTED_CURSOR]);
/* Reads a cursor into the members of *last that st_card_page uses.
 * Returns false with bad_cursor if the text is no cursor of a list of meshes in this order. */
bool api_sorted_cursor_read(const char *text, st_card_order order, st_card *last,
                            api_problem *problem);

#endif
