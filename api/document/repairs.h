/* repairs.h - the repairs that a request asks for, and the report of what they changed. */
#ifndef HE_API_DOCUMENT_REPAIRS_H
#define HE_API_DOCUMENT_REPAIRS_H

#include "api/request/exchange.h"
#include "format/io/format.h"
#include "repair/repair.h"

/* Reads ?repair=, ?tolerance= and ?hole_edges=. Returns false for a parameter that no requested
 * repair uses.
 */
bool api_repairs_read(api_exchange *x, he_repair_plan *plan);

/* Writes the array "repairs" of the report: one object per requested repair, in the order in which
 * they were applied. `import` knows where in the file the removed elements were; NULL if the body
 * was a JSON document. */
void api_repairs_write(api_out *out, const he_repair_plan *plan, const he_repaired *done,
                       const he_import *import);

#endif
