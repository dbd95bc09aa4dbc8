/* repairs.h - the repairs a request asks for, and the account of what they did. */
#ifndef HE_API_DOCUMENT_REPAIRS_H
#define HE_API_DOCUMENT_REPAIRS_H

#include "api/request/exchange.h"
#include "format/io/format.h"
#include "repair/repair.h"

/* ?repair= with ?tolerance= and ?hole_edges=. False: refused, for one that nothing asked for needs.
 */
bool api_repairs_read(api_exchange *x, he_repair_plan *plan);

/* The member "repairs" of an object that is open: an object for each repair that was asked for, in
 * the order in which they were applied. `import` gives the places of what is gone; NULL where the
 * body was JSON. */
void api_repairs_write(api_out *out, const he_repair_plan *plan, const he_repaired *done,
                       const he_import *import);

#endif
