/* problem.h - every refusal a client can see, as RFC 9457 problem+json.
 *
 * A code is either a refusal of core (an he_status, same number and slug) or one of API_CODE_MAP.
 * Its row says the HTTP status, the title, and the paragraph served at /problems/{slug}, which is
 * the problem's `type`. Code that detects an error, in the server too, fills an api_problem and
 * calls api_problem_write. */
#ifndef HE_API_JSON_PROBLEM_H
#define HE_API_JSON_PROBLEM_H

#include "api/json/text.h"
#include "build/build.h"
#include "store/publish/durability_wait.h"

/* Each row: X(constant, slug, HTTP status, title, explanation) */
#define API_CODE_MAP(X)                                                                            \
    /* refusals because of the body */                                                             \
    X(MALFORMED_JSON, "malformed_json", 400, "The body is not the JSON it should be",              \
      "The body must be one JSON value in UTF-8, as RFC 8259 defines it: no trailing commas, "     \
      "comments, leading zeros, raw control characters, lone surrogates, null characters or "      \
      "byte order mark, nothing after the value, and no deeper than 32 levels.")                   \
    X(UNKNOWN_MEMBER, "unknown_member", 400, "A member is not known here",                         \
      "Objects take the members that are documented and no others, so that a misspelt one is "     \
      "never ignored. The pointer names the member.")                                              \
    X(DUPLICATE_MEMBER, "duplicate_member", 400, "A member is given twice",                        \
      "An object may hold each member once. The pointer names the one that is repeated.")          \
    X(MISSING_MEMBER, "missing_member", 400, "A member is missing",                                \
      "The object at the pointer lacks a member it must have.")                                    \
    X(WRONG_TYPE, "wrong_type", 400, "A value has the wrong type",                                 \
      "The value at the pointer is of another JSON type than this place takes.")                   \
    X(UNEXPECTED_BODY, "unexpected_body", 400, "This request takes no body",                       \
      "The route reads no body, so one that comes with the request is refused rather than "        \
      "ignored.")                                                                                  \
    X(MISSING_BODY, "missing_body", 400, "A body is missing",                                      \
      "The route needs a body and the request has none.")                                          \
    X(UNKNOWN_OPERATION, "unknown_operation", 400, "No such operation",                            \
      "GET /v1/operations lists the operations by name.")                                          \
    X(CONFLICTING_MEMBERS, "conflicting_members", 400, "Members exclude each other",               \
      "The object gives two members that are alternatives of one another, such as an element "     \
      "and its list.")                                                                             \
    X(BAD_REFERENCE, "bad_reference", 400, "A reference names nothing earlier",                    \
      "A string such as \"$a.vertex\" stands for a result of an earlier operation of the same "    \
      "list: that operation carries \"as\":\"a\" and has a result of this name and a fitting "     \
      "kind.")                                                                                     \
    X(REPEATED_NAME, "repeated_name", 400, "A name is given twice in one list",                    \
      "Each \"as\" name may be used for one operation of a list.")                                 \
    /* refusals because of the request line and its headers */                                     \
    X(BAD_PATH, "bad_path", 400, "The path is not well formed",                                    \
      "Percent escapes must be two hexadecimal digits and decode to UTF-8 without a null "         \
      "character or a slash.")                                                                     \
    X(BAD_QUERY, "bad_query", 400, "The query is not well formed",                                 \
      "The query is name=value pairs joined by '&', percent-encoded UTF-8.")                       \
    X(UNKNOWN_PARAMETER, "unknown_parameter", 400, "A query parameter is not known here",          \
      "The route takes the parameters that are documented and no others.")                         \
    X(REPEATED_PARAMETER, "repeated_parameter", 400, "A query parameter is given twice",           \
      "Each query parameter may be given once.")                                                   \
    X(BAD_PARAMETER, "bad_parameter", 400, "A query parameter has a bad value",                    \
      "The value is not of the parameter's type or outside its range.")                            \
    X(BAD_CURSOR, "bad_cursor", 400, "The cursor is not one of this collection",                   \
      "A cursor is taken as it was given in `next` and used with the same collection.")            \
    X(BAD_HEADER, "bad_header", 400, "A header is not well formed",                                \
      "The value of a request header does not follow its syntax.")                                 \
    X(BAD_ID, "bad_id", 400, "The id cannot name a mesh",                                          \
      "A mesh id is 1 to 64 of the characters A-Z a-z 0-9 . _ - and neither \".\" nor \"..\".")    \
    X(RESERVED_NAME, "reserved_name", 400, "The name is not free for attributes",                  \
      "Positions are built in: they are changed by the operations vertex_move and transform, and " \
      "read with the vertices.")                                                                   \
    X(BAD_FRAMING, "bad_framing", 400, "The request is ambiguous",                                 \
      "A byte of the message is not where RFC 9112 has it, or its headers leave open where its "   \
      "body ends or which host it is for. The connection is closed, since another server might "   \
      "read the rest of it differently.")                                                          \
    X(BAD_ENCODING, "bad_encoding", 400, "The body is not what Content-Encoding says",             \
      "The bytes do not follow the coding, a checksum or length in them does not hold, something " \
      "else follows, or the body ends too early. The detail names the byte, counted from 0 in "    \
      "the body as it was sent.")                                                                  \
    X(BAD_MULTIPART, "bad_multipart", 400, "The body is not multipart/form-data",                  \
      "Its parts do not follow RFC 7578: each has a Content-Disposition: form-data with a name, "  \
      "none has parts itself, no two files have one name, and the last delimiter ends in two "     \
      "hyphens. The detail names the byte, counted from 0 in the body when it is decoded.")        \
    X(UNAUTHORIZED, "unauthorized", 401, "A token is needed",                                      \
      "The header Authorization: Bearer TOKEN is missing, or its token is not one of the "         \
      "server's, "                                                                                 \
      "or has expired. Whoever runs the server has them: its option --tokens names their file.")   \
    X(FORBIDDEN, "forbidden", 403, "This is not allowed",                                          \
      "The token is good, but its role does not include this. `role` is the least that does: "     \
      "read, write, admin or metrics.")                                                            \
    X(PREFIX, "prefix", 403, "The id is not one for this token",                                   \
      "The token makes meshes whose ids begin with one of its prefixes, and sees no others. "      \
      "GET /v1/token lists them; without an id the server makes one that fits.")                   \
    X(FOREIGN_ORIGIN, "foreign_origin", 403, "The request comes from another site",                \
      "Writes that a browser sends on behalf of a page of another origin are refused.")            \
    X(NO_SUCH_ROUTE, "no_such_route", 404, "There is nothing at this path",                        \
      "GET /v1/openapi.json lists every path.")                                                    \
    X(NO_SUCH_MESH, "no_such_mesh", 404, "No such mesh",                                           \
      "No mesh has this id, or it was deleted. In a body the status is 422.")                      \
    X(NO_SUCH_ATTRIBUTE, "no_such_attribute", 404, "No such attribute",                            \
      "The mesh has no attribute of this name in this domain; GET .../attributes lists those it "  \
      "has. Where a body names one, the status is 422.")                                           \
    X(NO_SUCH_JOB, "no_such_job", 404, "No such job",                                              \
      "No job has this id, or it ended so long ago that it was forgotten.")                        \
    X(NO_SUCH_RESULT, "no_such_result", 404, "The job has no result",                              \
      "It failed, was cancelled, or was answered without a body; or there was no room to keep "    \
      "the "                                                                                       \
      "body. The job itself says which.")                                                          \
    X(NO_SUCH_REVISION, "no_such_revision", 404, "The mesh has no such revision yet",              \
      "The revision that is named is beyond the present one, which every answer about the mesh "   \
      "shows.")                                                                                    \
    X(METHOD_NOT_ALLOWED, "method_not_allowed", 405, "The path does not take this method",         \
      "The Allow header lists the methods it takes.")                                              \
    X(NOT_ACCEPTABLE, "not_acceptable", 406, "No acceptable representation",                       \
      "None of the media types this route answers with is allowed by the Accept header, or no "    \
      "content coding by Accept-Encoding. `supported` lists them.")                                \
    X(TIMEOUT, "timeout", 408, "The request took too long to arrive",                              \
      "The request was not complete within the server's deadline.")                                \
    X(MESH_EXISTS, "mesh_exists", 409, "The id is taken", "Another mesh has this id.")             \
    X(NOTHING_TO_UNDO, "nothing_to_undo", 409, "There is nothing to undo",                         \
      "The undo stack of the mesh is empty.")                                                      \
    X(NOTHING_TO_REDO, "nothing_to_redo", 409, "There is nothing to do again",                     \
      "The redo stack of the mesh is empty: nothing was undone, or an edit followed.")             \
    X(UNREACHABLE_REVISION, "unreachable_revision", 409, "The stack does not lead there",          \
      "Undo leads to revisions whose edits are all still done, redo to those that were undone "    \
      "last. What was undone and then edited over is on neither stack: it can be read with "       \
      "?revision= while the history holds it.")                                                    \
    X(MESH_BUSY, "mesh_busy", 409, "The mesh is being changed by a long operation",                \
      "Writes are taken again when it has ended; reads go on meanwhile.")                          \
    X(IDEMPOTENCY_BUSY, "idempotency_in_progress", 409, "The same request is under way",           \
      "A request with this Idempotency-Key is being answered. Ask again after Retry-After "        \
      "seconds: its answer is given then.")                                                        \
    X(BACKUP_KEPT, "backup_kept", 409, "There is a backup already",                                \
      "The server keeps one at a time, since it takes as much room as the store. Fetch it from "   \
      "its job and DELETE the job, or wait until it has ended.")                                   \
    X(NOTHING_KEPT, "nothing_kept", 409, "There is nothing to back up",                            \
      "The server was started with --store memory.")                                               \
    X(RELOAD_FAILED, "reload_failed", 409, "A file cannot be taken",                               \
      "A file that the server was to read again is wrong; the detail says where. What was in "     \
      "force before stays.")                                                                       \
    X(REVISION_GONE, "revision_gone", 410, "The revision is not available any more",               \
      "A cursor or parameter names a revision the server no longer holds. Start again without "    \
      "it.")                                                                                       \
    X(STALE, "stale_revision", 412, "The mesh is at another revision",                             \
      "If-Match or expected_revision names another revision than the present one, which is in "    \
      "`revision`. Read the mesh again and decide anew.")                                          \
    X(PRECONDITION, "precondition_failed", 412, "The precondition does not hold",                  \
      "If-None-Match: * asks that the mesh does not exist, and it does; or If-Match asks that it " \
      "does, and it does not.")                                                                    \
    X(BODY_TOO_LARGE, "body_too_large", 413, "The body is too large",                              \
      "The body exceeds the limit of its route. A coded one may also unfold to too many times "    \
      "what was sent, or want too large a window: sent plain, or with less effort, it may do.")    \
    X(URI_TOO_LONG, "uri_too_long", 414, "The path and query are too long",                        \
      "Path and query together may have 8192 characters.")                                         \
    X(UNSUPPORTED_MEDIA_TYPE, "unsupported_media_type", 415, "The media type is not supported",    \
      "The Content-Type is none of those the route reads; `supported` lists them.")                \
    X(UNSUPPORTED_ENCODING, "unsupported_encoding", 415, "The content coding is not supported",    \
      "Content-Encoding may be gzip, zstd or identity, and one of them only. Accept-Encoding and " \
      "`supported` list them.")                                                                    \
    X(WRONG_HOST, "wrong_host", 421, "The Host is not one this server answers for",                \
      "Host must name localhost, a loopback address or a configured name, so that a web page "     \
      "cannot reach a local server through a name of its own.")                                    \
    X(HEADERS_TOO_LARGE, "headers_too_large", 431, "The headers are too large",                    \
      "A request may have 100 headers and 16384 bytes of them, fewer with a long target.")         \
    X(IDEMPOTENCY_MISMATCH, "idempotency_mismatch", 422, "The key is of another request",          \
      "A request that carries the Idempotency-Key of one that was answered within a day must be "  \
      "the same in method, path, query, Content-Type and body.")                                   \
    X(UNCLEAR_PARTS, "unclear_parts", 422, "It is not clear which file is the mesh",               \
      "One file of a multipart/form-data body must have a format that the server reads: by its "   \
      "name or media type or, if no file has, by its first bytes; the others are those that it "   \
      "refers to. ?format= says which one is meant where several could be.")                       \
    X(RATE_LIMIT, "rate_limit", 429, "Too many requests",                                          \
      "The token, or without one the address, has had all the requests or bytes a second that it " \
      "may. The detail says which; RateLimit-Policy tells the limits, RateLimit what is left. "    \
      "Try again after Retry-After seconds.")                                                      \
    X(TOO_MANY_CONNECTIONS, "too_many_connections", 429, "Too many connections of one address",    \
      "The address has as many connections as one may. This one is closed; use those that are "    \
      "open, or try again after Retry-After seconds.")                                             \
    X(TOO_MANY_JOBS_OF_TOKEN, "too_many_jobs_of_token", 429, "Too many jobs of one token",         \
      "As many jobs of the token wait or run as it may have. Try again after Retry-After "         \
      "seconds, or cancel one.")                                                                   \
    X(INTERNAL, "internal", 500, "The server made a mistake",                                      \
      "The request may be fine; the server broke one of its own rules answering it.")              \
    X(MESH_DAMAGED, "mesh_damaged", 500, "The mesh is damaged",                                    \
      "The disk does not have what was written to it. The mesh can be deleted, or replaced by "    \
      "PUT; all others are served.")                                                               \
    X(MESH_NEWER, "mesh_newer", 500, "A newer release has written the mesh",                       \
      "What is on the disk of it is of a version that this release does not know; the newer one "  \
      "reads it. Until then it can be deleted, or replaced by PUT; all others are served.")        \
    X(NOT_IMPLEMENTED, "not_implemented", 501, "The server does not implement this",               \
      "The method is longer than any there is, or the body has a transfer coding other than "      \
      "chunked. The connection is closed.")                                                        \
    X(NOT_READY, "not_ready", 503, "The server is not ready",                                      \
      "It is starting or stopping. Try again later.")                                              \
    X(OVERLOADED, "overloaded", 503, "Too many connections",                                       \
      "The server is at its limit of connections. Try again after Retry-After seconds.")           \
    X(TOO_MANY_CODED, "too_many_coded_bodies", 503, "Too many coded bodies are arriving",          \
      "What it takes to unfold the gzip and zstd bodies that are arriving has a common limit. "    \
      "Try again after Retry-After seconds, or send the body plain.")                              \
    X(READ_TIMEOUT, "read_timeout", 503, "What was asked takes too long to find",                  \
      "A client may wait only so long for a read, because others wait for the thread. Ask for "    \
      "less at once or for a job, which has the time it needs, with the header Prefer: "           \
      "respond-async. What all elements of a mesh are read for takes that header.")                \
    X(TOO_MANY_JOBS, "too_many_jobs", 503, "Too many jobs are waiting",                            \
      "The queue of jobs is full. Try again after Retry-After seconds.")                           \
    X(TOO_MANY_TICKETS, "too_many_tickets", 503, "Too many tickets are good",                      \
      "A ticket is good for a minute or until it is used, and only so many may be. Try again "     \
      "after Retry-After seconds.")                                                                \
    X(LOADING, "loading", 503, "The mesh is being loaded",                                         \
      "Reading it from the disk takes longer than a request waits for it. Try again after "        \
      "Retry-After seconds.")                                                                      \
    X(STORE_BEHIND, "store_behind", 503, "The disk is behind",                                     \
      "Too many changes are waiting for the disk. Nothing was changed; try again after "           \
      "Retry-After seconds.")                                                                      \
    X(STORE_LOST, "store_lost", 503, "What the answer would show was lost",                        \
      "It would show a change by another request that could not be kept. Nothing was changed; "    \
      "the same request, sent again, shows what was kept.")                                        \
    X(STORE_FAILED, "store_failed", 503, "The disk failed",                                        \
      "A write or a sync of the disk failed. The change was not made, or is lost. Reads go on, "   \
      "but no change is taken until the server is started again.")                                 \
    X(INTERRUPTED, "interrupted", 503, "The server stopped before the job had ended",              \
      "Of a job alone: it was accepted, and waited or ran when the server stopped or was killed. " \
      "Nothing of it was done, and nothing was changed; send the request again.")                  \
    X(BACKUP_FAILED, "backup_failed", 503, "The backup was not made",                              \
      "The detail says why: most likely there is no room for it beside the store.")                \
    X(VERSION_NOT_SUPPORTED, "version_not_supported", 505, "The HTTP version is not supported",    \
      "HTTP/1.1 and HTTP/1.0 are. The connection is closed.")                                      \
    X(STORE_FULL, "store_full", 507, "The disk is full",                                           \
      "The change was not made, or is lost. Reads go on, meshes can be deleted, and changes are "  \
      "taken again as soon as there is room.")                                                     \
    X(MEMORY_BUDGET, "memory_budget", 507, "The memory budget is used up",                         \
      "What the request needs does not fit the configured budget beside what is in use. Delete a " \
      "mesh and try again, or try again later.")                                                   \
    X(QUOTA, "quota", 507, "The token's quota is used up",                                         \
      "The token that made the mesh may hold only so many meshes, or so many bytes of memory in "  \
      "them; the detail says which. Nothing was changed. Delete a mesh of that token, or make "    \
      "one smaller.")                                                                              \
    X(TOO_MANY_MESHES, "too_many_meshes", 507, "There are too many meshes",                        \
      "The configured number of meshes is reached. Delete one and try again.")

/* The numbers of he_status come first, then those of API_CODE_MAP. HE_OK means "no problem". */
typedef enum api_code {
    API_CODE_BASE = HE_STATUS_COUNT - 1,
#define API_CODE_ENUM(constant, slug, status, title, text) API_##constant,
    API_CODE_MAP(API_CODE_ENUM)
#undef API_CODE_ENUM
        API_CODE_COUNT
} api_code;

enum { API_PROBLEM_DETAIL = 320, API_PROBLEM_POINTER = 256 };

/* {0} is "no problem". */
typedef struct api_problem {
    int code;                        /* api_code or he_status; HE_OK: none */
    int status;                      /* HTTP status; 0: the one of the code */
    char detail[API_PROBLEM_DETAIL]; /* one sentence, UTF-8 */
    bool has_pointer;                /* "" points at the whole body */
    char pointer[API_PROBLEM_POINTER];
    bool has_element;
    he_kind kind;
    uint32_t id;
    bool has_revision; /* `revision` is set: the present revision, with 412 */
    uint64_t revision;
    const he_report *report; /* source of `elements` and `total`, borrowed; NULL: none */
    unsigned repairs; /* the set of repairs with which the body would pass (repair.h); 0: none */
    bool report_pointers; /* the body is a mesh document: add "/faces/3/1" to each element */
    const char *const *supported; /* supported types, with 406 and 415; ends in NULL, borrowed */
    uint64_t retry;               /* seconds until a retry makes sense; 0: unknown */
    const char *role; /* the role that the token lacks, with 403; a literal. NULL: none */
} api_problem;

/* Returns the slug of a code; never NULL. */
const char *api_code_slug(int code);
const char *api_code_title(int code);
const char *api_code_explanation(int code);
int api_code_http(int code);
/* Returns the code with this slug, or -1. */
int api_code_find(const char *slug);

/* Both fill `problem` from scratch; no argument may be NULL. They return false, so that a refusal
 * is one statement. If `problem` is filled already, it is not changed: the first problem is
 * reported. */
bool api_problem_set(api_problem *problem, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Fills the problem from a refusal of core about a body; elements that do not exist give the status
 * 422. */
bool api_problem_set_core(api_problem *problem, const he_error *err);
/* Fills the problem from a refusal of core about the path; elements that do not exist give the
 * status 404 or 410. */
bool api_problem_set_path(api_problem *problem, const he_error *err);
/* Refuses an answer because its content did not become durable; `wait` has the reason. `changed`
 * says that the request itself made the change that was lost. */
bool api_problem_set_lost(api_problem *problem, const st_wait *wait, bool changed);
void api_problem_set_pointer(api_problem *problem, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Adds to a problem the names of the repairs with which the body would be accepted, as a member and
 * in `detail`. */
void api_problem_set_repairs(api_problem *problem, unsigned repairs);

/* Writes the place of a defect in a mesh document: "/faces/3/1". */
enum { API_DEFECT_POINTER = 40 };
void api_defect_pointer(const he_defect *defect, char out[API_DEFECT_POINTER]);

int api_problem_http(const api_problem *problem);
/* Returns the value of the header Retry-After, in `out` or as a literal; NULL if waiting does not
 * help. */
enum { API_RETRY = 24 };
const char *api_problem_retry(const api_problem *problem, char out[API_RETRY]);
/* Returns the JSON object that is sent, with status 507, if there is no memory to write one; a
 * literal. */
const char *api_problem_unwritten(void);
/* Appends the problem as a JSON object to `text`; `request_id` may be NULL. HE_NO_MEMORY is written
 * as API_MEMORY_BUDGET if it was the memory budget that refused. */
void api_problem_write(const api_problem *problem, const char *request_id, api_text *text);
/* Writes the HTML page that explains a code, served at /problems/{code}. */
void api_problem_page(int code, api_text *text);

#endif
