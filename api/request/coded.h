/* coded.h - content codings of an exchange: what its body came in, what its answer goes out in.
 *
 * An answer is coded as Accept-Encoding likes it best (coding.h), unless it is an event stream, has
 * no more than API_PACK_FROM bytes, is of a type that is packed already, or would not become
 * shorter. Its ETag is then one of its own, since it is strong: "...-gzip". If-None-Match is
 * answered 304 for the tag of any coding the client still accepts, and that tag is what the 304
 * names; If-Match looks at the state only, so a tag is as good from an answer of any coding. */
#ifndef HE_API_REQUEST_CODED_H
#define HE_API_REQUEST_CODED_H

#include "api/request/exchange.h"

/* Of a request that has a body: fill x->coding_in, or 415. */
bool api_coded_body(api_exchange *x);
/* Fill x->codings, or 406. */
bool api_coded_accept(api_exchange *x);
/* Does the answer depend on Accept-Encoding? */
bool api_coded_varies(const api_exchange *x);
/* The answer is complete: code it. Where there is no memory for that it stays as it is. */
void api_coded_answer(api_exchange *x);

#endif
