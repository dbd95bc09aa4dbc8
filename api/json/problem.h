/* problem.h - all refusals that clients can get, in the format problem+json of RFC 9457.
 *
 * A code is either a refusal of core (an he_status, same number and slug) or one of API_CODE_MAP.
 * For each code there is an HTTP status, the title, and a paragraph that explains it, shown by the
 * page /problems/{slug}, whose path is the problem's `type`. All code that detects an error, also
 * in server/, fills an api_problem, which api_problem_write writes. */
#ifndef HE_API_JSON_PROBLEM_H
#define HE_API_JSON_PROBLEM_H

#include "api/json/record.h"
#include "build/build.h"
#include "store/publish/durability_wait.h"

/* Each row: X(constant, slug, HTTP status, title, explanation) */
#define API_CODE_MAP(X)                                                                            \
    /* refusals because of the request's body */                                                   \
    X(MALFORMED_JSON, "malformed_json", 400, "The body is not valid JSON",                         \
      "The body must be one JSON value in UTF-8, as RFC 8259 defines it: no trailing commas, "     \
      "comments, leading zeros, raw control characters, lone surrogates, null characters or "      \
      "byte order mark, nothing after the value, and no deeper than 32 levels.")                   \
    X(UNKNOWN_MEMBER, "unknown_member", 400, "There is no such member",                            \
      "Objects may have only the members that are documented, so that a misspelt one is "          \
      "never ignored. The pointer names the member.")                                              \
    X(DUPLICATE_MEMBER, "duplicate_member", 400, "A member is given twice",                        \
      "An object may have each member only once. The pointer names the repeated member.")          \
    X(MISSING_MEMBER, "missing_member", 400, "A member is missing",                                \
      "The object at the pointer needs a member that it does not have.")                           \
    X(WRONG_TYPE, "wrong_type", 400, "A value has the wrong type",                                 \
      "The value at the pointer does not have the JSON type that the documentation of this "       \
      "member demands.")                                                                           \
    X(UNEXPECTED_BODY, "unexpected_body", 400, "This request must not have a body",                \
      "This combination of path and method takes no body. The server refuses the body rather "     \
      "than ignore it.")                                                                           \
    X(MISSING_BODY, "missing_body", 400, "A body is missing",                                      \
      "The path and method need a body, and the request has none.")                                \
    X(UNKNOWN_OPERATION, "unknown_operation", 400, "No such operation",                            \
      "GET /v1/operations lists the operations by name.")                                          \
    X(CONFLICTING_MEMBERS, "conflicting_members", 400, "Members exclude each other",               \
      "The object has two members of which it may have only one, such as `face` and `faces`.")     \
    X(BAD_REFERENCE, "bad_reference", 400, "A reference does not name an earlier result",          \
      "A string such as \"$a.vertex\" stands for the result `vertex` of an earlier operation of "  \
      "the list, which has the member \"as\":\"a\". The list has no earlier operation with this "  \
      "name, or its result is not of the kind that the parameter needs.")                          \
    X(REPEATED, "repeated", 400, "A list names an element twice",                                  \
      "An operation runs once for each element of the list, so an element may be named only "      \
      "once.")                                                                                     \
    X(REPEATED_NAME, "repeated_name", 400, "A name is given twice in one list",                    \
      "Two operations of a list may not have the same name in `as`.")                              \
    /* refusals because of the request line and its headers */                                     \
    X(BAD_PATH, "bad_path", 400, "The path is not well formed",                                    \
      "Percent escapes must be two hexadecimal digits and decode to UTF-8 without a null "         \
      "character or a slash.")                                                                     \
    X(BAD_QUERY, "bad_query", 400, "The query is not well formed",                                 \
      "The query is name=value pairs joined by '&', percent-encoded UTF-8.")                       \
    X(UNKNOWN_PARAMETER, "unknown_parameter", 400, "There is no such query parameter",             \
      "A request may have only the query parameters that are documented for its path.")            \
    X(REPEATED_PARAMETER, "repeated_parameter", 400, "A query parameter is given twice",           \
      "Each query parameter may be given once.")                                                   \
    X(BAD_PARAMETER, "bad_parameter", 400, "A query parameter has a bad value",                    \
      "The value of the query parameter does not have the parameter's type, or is out of its "     \
      "range.")                                                                                    \
    X(BAD_CURSOR, "bad_cursor", 400, "The cursor does not belong to this collection",              \
      "Use a cursor exactly as the member `next` of an answer gave it, and only with the list "    \
      "that gave it.")                                                                             \
    X(BAD_HEADER, "bad_header", 400, "A header is not well formed",                                \
      "The value of a request header does not follow its syntax.")                                 \
    X(BAD_ID, "bad_id", 400, "The text cannot be the id of a mesh",                                \
      "A mesh id is 1 to 64 of the characters A-Z a-z 0-9 . _ - and neither \".\" nor \"..\".")    \
    X(RESERVED_NAME, "reserved_name", 400, "The name is reserved",                                 \
      "Positions are not an attribute: the operations vertex_move and transform change "           \
      "them, and they are read with the vertices.")                                                \
    X(BAD_FRAMING, "bad_framing", 400, "The request is ambiguous",                                 \
      "The message does not follow RFC 9112, or its headers do not say clearly where its body "    \
      "ends or which host it is for. The connection is closed, because another server might read " \
      "the rest of the message differently.")                                                      \
    X(BAD_ENCODING, "bad_encoding", 400, "The body is not what Content-Encoding says",             \
      "The compressed data is malformed, a checksum or length in it is wrong, other data "         \
      "follows it, or it ends too early. The detail names the byte, counted from 0 in the "        \
      "body as it was sent.")                                                                      \
    X(BAD_MULTIPART, "bad_multipart", 400, "The body is not multipart/form-data",                  \
      "The parts of the body do not follow RFC 7578: each part has a Content-Disposition: "        \
      "form-data with a name, no part has parts itself, no two files have the same name, and the " \
      "last delimiter ends in two hyphens. The detail names the byte, counted from 0 in the body " \
      "when it is decoded.")                                                                       \
    X(UNAUTHORIZED, "unauthorized", 401, "A token is needed",                                      \
      "The header Authorization: Bearer TOKEN is missing, or the server does not know the "        \
      "token, or it has expired. The administrator of the server makes tokens: its option "        \
      "--tokens names their file.")                                                                \
    X(FORBIDDEN, "forbidden", 403, "The token does not allow this request",                        \
      "The token is valid, but its role does not allow this request. The member `role` names a "   \
      "role that does: read, write, admin or metrics.")                                            \
    X(PREFIX, "prefix", 403, "This token may not use this mesh id",                                \
      "The token can create and see only meshes whose ids begin with one of its prefixes. GET "    \
      "/v1/token lists the prefixes. If a request to create a mesh gives no id, the server "       \
      "chooses an id with such a prefix.")                                                         \
    X(FOREIGN_ORIGIN, "foreign_origin", 403, "The request comes from another site",                \
      "The server refuses changes and expensive reads that a browser sends for a page of another " \
      "origin.")                                                                                   \
    X(NO_SUCH_ROUTE, "no_such_route", 404, "There is nothing at this path",                        \
      "The server has no such path. GET /v1/openapi.json lists every path.")                       \
    X(NO_SUCH_MESH, "no_such_mesh", 404, "No such mesh",                                           \
      "No mesh has this id, or the mesh was deleted. The status is 404 if the id is in the path, " \
      "and 422 if it is in the body.")                                                             \
    X(NO_SUCH_JOB, "no_such_job", 404, "No such job",                                              \
      "No job has this id, or the job ended so long ago that the server has forgotten it.")        \
    X(NO_SUCH_RESULT, "no_such_result", 404, "The job has no result",                              \
      "The job failed, was cancelled, or was answered without a body; or there was no room to "    \
      "keep the body. GET of the job says which of these happened.")                               \
    X(NO_SUCH_REVISION, "no_such_revision", 404, "The mesh has no such revision yet",              \
      "The requested revision is higher than the present revision, which every answer about the "  \
      "mesh shows.")                                                                               \
    X(METHOD_NOT_ALLOWED, "method_not_allowed", 405, "The path does not support this method",      \
      "The header Allow lists the methods that the path supports.")                                \
    X(NOT_ACCEPTABLE, "not_acceptable", 406, "No acceptable representation",                       \
      "The header Accept allows none of the media types of the answer, or Accept-Encoding allows " \
      "none of its content codings. The member `supported` lists the possible ones.")              \
    X(TIMEOUT, "timeout", 408, "The request took too long to arrive",                              \
      "The request was not complete within the server's deadline.")                                \
    X(MESH_EXISTS, "mesh_exists", 409, "The id already belongs to a mesh",                         \
      "Another mesh has this id.")                                                                 \
    X(NOTHING_TO_UNDO, "nothing_to_undo", 409, "There is nothing to undo",                         \
      "The undo history of the mesh is empty.")                                                    \
    X(NOTHING_TO_REDO, "nothing_to_redo", 409, "There is nothing to redo",                         \
      "The redo history of the mesh is empty: nothing was undone, or a new edit was made "         \
      "after the undo.")                                                                           \
    X(UNREACHABLE_REVISION, "unreachable_revision", 409, "Undo or redo cannot reach the revision", \
      "Undo goes back only over edits that are still in effect, and redo repeats only edits that " \
      "were undone since the last new edit. If an edit was undone and a new edit was made "        \
      "afterwards, neither undo nor redo leads to the revision of the undone edit. It can still "  \
      "be read with ?revision= while the history holds it.")                                       \
    X(MESH_BUSY, "mesh_busy", 409, "The mesh is being changed by a long operation",                \
      "Changes are accepted again when the operation has ended; reads are possible meanwhile.")    \
    X(IDEMPOTENCY_BUSY, "idempotency_in_progress", 409, "The same request is in progress",         \
      "A request with this Idempotency-Key is in progress. Send it again after Retry-After "       \
      "seconds to get its answer.")                                                                \
    X(CLIENT_TAKEN, "client_taken", 409, "Another client has this id",                             \
      "A client with another token shows itself at the mesh with this id. Choose another one, at " \
      "random.")                                                                                   \
    X(BACKUP_KEPT, "backup_kept", 409, "Another backup is being made or kept",                     \
      "The server keeps only one backup at a time, because a backup takes as much room as the "    \
      "store. Fetch the backup from its job and then DELETE the job; if the job still runs, wait " \
      "until it is done.")                                                                         \
    X(NOTHING_KEPT, "nothing_kept", 409, "There is nothing to back up",                            \
      "The server was started with --store memory, and keeps nothing on the disk.")                \
    X(RELOAD_FAILED, "reload_failed", 409, "A file cannot be used",                                \
      "A file that the server was told to read again is wrong; the detail says where. The "        \
      "previous settings stay in effect.")                                                         \
    X(REVISION_GONE, "revision_gone", 410, "The revision is not available any more",               \
      "A cursor or a parameter names a revision that the server no longer holds. Send the "        \
      "request again without this cursor or parameter.")                                           \
    X(STALE, "stale_revision", 412, "The mesh is at another revision",                             \
      "If-Match or expected_revision does not name the present revision of the mesh, which the "   \
      "member `revision` of the problem tells. Read the mesh again, and then decide what to "      \
      "change.")                                                                                   \
    X(PRECONDITION, "precondition_failed", 412, "The precondition does not hold",                  \
      "With If-None-Match: * the mesh must not exist, but it exists; or with If-Match the mesh "   \
      "must exist, but it does not.")                                                              \
    X(BODY_TOO_LARGE, "body_too_large", 413, "The body is too large",                              \
      "The body is larger than this request allows. A compressed body is also refused if it "      \
      "decompresses to too many times its size, or needs too large a window: send it "             \
      "uncompressed, or with weaker compression.")                                                 \
    X(URI_TOO_LONG, "uri_too_long", 414, "The path and query are too long",                        \
      "Path and query together may have 8192 characters.")                                         \
    X(UNSUPPORTED_MEDIA_TYPE, "unsupported_media_type", 415, "The media type is not supported",    \
      "The Content-Type is not one of the media types that the member `supported` lists.")         \
    X(UNSUPPORTED_ENCODING, "unsupported_encoding", 415, "The content coding is not supported",    \
      "Content-Encoding may be gzip, zstd or identity, but only one of them. The header "          \
      "Accept-Encoding and the member `supported` list the codings.")                              \
    X(WRONG_HOST, "wrong_host", 421, "The server does not accept this Host",                       \
      "The header Host must name localhost, a loopback address or a name that the option "         \
      "--allow-host allows. Otherwise any web page could reach a local server by giving its own "  \
      "host name the server's address (DNS rebinding).")                                           \
    X(HEADERS_TOO_LARGE, "headers_too_large", 431, "The headers are too large",                    \
      "A request may have at most 100 headers with 16384 bytes in all, and fewer if its path and " \
      "query are long.")                                                                           \
    X(IDEMPOTENCY_MISMATCH, "idempotency_mismatch", 422, "The key was used for another request",   \
      "If a request has the Idempotency-Key of an earlier request of the last day, it must also "  \
      "have the same method, path, query, Content-Type and body.")                                 \
    X(UNCLEAR_PARTS, "unclear_parts", 422, "It is not clear which file is the mesh",               \
      "Exactly one file of a multipart/form-data body must be a mesh file, and the other files "   \
      "are files that it refers to. Names and media types show which file is a mesh file; if "     \
      "they show none, the first bytes of the files do. If there are several mesh files, "         \
      "?format= chooses the one of that format.")                                                  \
    X(RATE_LIMIT, "rate_limit", 429, "Too many requests",                                          \
      "The token (or, if the request has no token, the client's address) has used up its "         \
      "requests or its bytes per second; the detail says which. The header RateLimit-Policy "      \
      "shows the limits, and RateLimit shows how much is left. Try again after Retry-After "       \
      "seconds.")                                                                                  \
    X(TOO_MANY_CONNECTIONS, "too_many_connections", 429, "Too many connections from one address",  \
      "The client's address has as many connections as the server allows for one address. This "   \
      "connection is closed; use the open ones, or try again after Retry-After seconds.")          \
    X(TOO_MANY_JOBS_OF_TOKEN, "too_many_jobs_of_token", 429, "Too many jobs of one token",         \
      "The token has as many waiting and running jobs as the server allows for one token. Try "    \
      "again after Retry-After seconds, or cancel one of these jobs.")                             \
    X(INTERNAL, "internal", 500, "The server has an internal error",                               \
      "The request may be correct: the fault is in the server, not in the request.")               \
    X(MESH_DAMAGED, "mesh_damaged", 500, "The mesh is damaged",                                    \
      "The data of the mesh on the disk is not what was written. The mesh can be deleted, "        \
      "or replaced by PUT; other meshes are not affected.")                                        \
    X(MESH_NEWER, "mesh_newer", 500, "A newer release has written the mesh",                       \
      "The data of the mesh on the disk has a version that this release does not know; a newer "   \
      "release can read it. In this release the mesh can only be deleted, or replaced by PUT; "    \
      "other meshes are not affected.")                                                            \
    X(NOT_IMPLEMENTED, "not_implemented", 501, "The server does not implement this",               \
      "The method is unknown, or the body has a transfer coding other than chunked. The server "   \
      "closes the connection.")                                                                    \
    X(NOT_READY, "not_ready", 503, "The server is not ready",                                      \
      "The server is starting or stopping. Try again later.")                                      \
    X(OVERLOADED, "overloaded", 503, "Too many connections",                                       \
      "The server has as many open connections as it allows. Try again after Retry-After "         \
      "seconds.")                                                                                  \
    X(TOO_MANY_CODED, "too_many_coded_bodies", 503, "Too many compressed bodies are arriving",     \
      "The memory to decompress arriving gzip and zstd bodies is limited. Try again after "        \
      "Retry-After seconds, or send the body uncompressed.")                                       \
    X(READ_TIMEOUT, "read_timeout", 503, "The answer takes too long to compute",                   \
      "The time for a read is limited, because other requests need the thread. Ask for less in "   \
      "one request, or ask for a job, which has no limit, with the header Prefer: respond-async. " \
      "All reads of a whole mesh accept this header.")                                             \
    X(TOO_MANY_JOBS, "too_many_jobs", 503, "Too many jobs are waiting",                            \
      "The queue of jobs is full. Try again after Retry-After seconds.")                           \
    X(TOO_MANY_PRESENT, "too_many_present", 503, "Too many clients show themselves",               \
      "The server limits the number of clients that show themselves to others at one mesh, and "   \
      "at all meshes together. A client is forgotten half a minute after it was last heard of. "   \
      "Try again after Retry-After seconds.")                                                      \
    X(TOO_MANY_TICKETS, "too_many_tickets", 503, "Too many tickets are waiting to be used",        \
      "A ticket is valid for a minute or until it is used, and the server limits the number of "   \
      "valid tickets. Try again after Retry-After seconds.")                                       \
    X(LOADING, "loading", 503, "The mesh is being loaded",                                         \
      "Reading the mesh from the disk takes longer than a request may wait. Try again after "      \
      "Retry-After seconds.")                                                                      \
    X(STORE_BEHIND, "store_behind", 503, "The disk is too slow for the number of changes",         \
      "Too many changes are waiting to be written to the disk. Nothing was changed; try again "    \
      "after Retry-After seconds.")                                                                \
    X(STORE_LOST, "store_lost", 503, "A change that the answer would show could not be saved",     \
      "The answer would show a change by another request, and that change could not be saved on "  \
      "the disk. This request changed nothing; send it again to see what was saved.")              \
    X(STORE_FAILED, "store_failed", 503, "The disk failed",                                        \
      "A write or a sync of the disk failed. The change was not made, or is lost. Reads are "      \
      "still possible, but no changes are accepted until the server is restarted.")                \
    X(INTERRUPTED, "interrupted", 503, "The server stopped before the job had ended",              \
      "The job was waiting or running when the server stopped or was killed. The job changed "     \
      "nothing; send its request again.")                                                          \
    X(BACKUP_FAILED, "backup_failed", 503, "The backup was not made",                              \
      "The detail says why. Most likely the disk has not enough space for a copy of the store.")   \
    X(VERSION_NOT_SUPPORTED, "version_not_supported", 505, "The HTTP version is not supported",    \
      "The server supports HTTP/1.1 and HTTP/1.0. The connection is closed.")                      \
    X(STORE_FULL, "store_full", 507, "The disk is full",                                           \
      "The change was not made, or is lost. Reads are still possible, meshes can be "              \
      "deleted, and changes are accepted again as soon as there is room.")                         \
    X(MEMORY_BUDGET, "memory_budget", 507, "The memory budget is used up",                         \
      "The request needs more memory than the configured memory budget has left. Delete a mesh "   \
      "and try again, or try again later.")                                                        \
    X(QUOTA, "quota", 507, "The token's quota is used up",                                         \
      "The number or the memory of meshes that a token has created is limited; the detail says "   \
      "which limit was reached. The token meant is the one that created the mesh. Nothing was "    \
      "changed. Delete a mesh of that token, or make one smaller.")                                \
    X(TOO_MANY_MESHES, "too_many_meshes", 507, "There are too many meshes",                        \
      "The server already has as many meshes as its configuration allows. Delete one and try "     \
      "again.")

/* The codes of problems. The numbers of he_status come first, then those of API_CODE_MAP. HE_OK
 * means "no problem". */
typedef enum api_code {
    API_CODE_BASE = HE_STATUS_COUNT - 1,
#define API_CODE_ENUM(constant, slug, status, title, text) API_##constant,
    API_CODE_MAP(API_CODE_ENUM)
#undef API_CODE_ENUM
        API_CODE_COUNT
} api_code;

enum { API_PROBLEM_DETAIL = 320, API_PROBLEM_POINTER = 256 };

/* A refusal of a request. {0} means that there is no problem. */
typedef struct api_problem {
    int code;                        /* an api_code or he_status; HE_OK: no problem */
    int status;                      /* HTTP status; 0 selects the status of `code` */
    char detail[API_PROBLEM_DETAIL]; /* the message: one sentence in UTF-8 */
    /* True if a JSON pointer is set; the pointer "" means the whole body. */
    bool has_pointer;
    char pointer[API_PROBLEM_POINTER];
    bool has_element;
    he_kind kind;
    uint32_t id;
    /* True if `revision` is set, to the mesh's present revision (with status 412). */
    bool has_revision;
    uint64_t revision;
    /* The report of defects, borrowed, from which the members "elements" and "total" are made;
     * NULL: none. */
    const he_report *report;
    /* Set of the repairs (repair.h) with which the body would be accepted; 0: none. */
    unsigned repairs;
    /* True if the body is a mesh document: each element of the report then gets a JSON pointer such
     * as "/faces/3/1". */
    bool report_pointers;
    /* Types or codings that would be accepted (406, 415); ends in NULL, borrowed. */
    const char *const *supported;
    uint64_t retry; /* seconds until a retry makes sense; 0: unknown */
    /* The role that the token lacks (with status 403), a string literal; NULL: none. */
    const char *role;
} api_problem;

/* Returns the slug of a code; never NULL. */
const char *api_code_slug(int code);
const char *api_code_title(int code);
const char *api_code_explanation(int code);
int api_code_http(int code);
/* Returns the code with this slug, or -1. */
int api_code_find(const char *slug);

/* api_problem_set, api_problem_set_core and api_problem_set_path fill an empty `problem` and return
 * false, so that a refusal is one statement. No argument may be NULL. A problem that is filled
 * already is not changed: the first problem is reported. */
bool api_problem_set(api_problem *problem, int code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Fills the problem from a refusal of core about the request's body; if an element does not exist,
 * the status is 422. */
bool api_problem_set_core(api_problem *problem, const he_error *err);
/* Fills the problem from a refusal of core about the request's path; if the element does not exist,
 * the status is 404 or 410. */
bool api_problem_set_path(api_problem *problem, const he_error *err);
/* Fills the problem that is sent instead of an answer if a change that the answer would show did
 * not become durable; `wait` has the reason. `changed` is true if the request itself made that lost
 * change. */
bool api_problem_set_lost(api_problem *problem, const st_wait *wait, bool changed);
void api_problem_set_pointer(api_problem *problem, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Adds to a problem the names of the repairs with which the body would be accepted, as a member and
 * in `detail`. */
void api_problem_set_repairs(api_problem *problem, unsigned repairs);

/* Writes the JSON pointer of a defect in a mesh document, such as "/faces/3/1". */
enum { API_DEFECT_POINTER = 40 };
void api_defect_pointer(const he_defect *defect, char out[API_DEFECT_POINTER]);

int api_problem_http(const api_problem *problem);
/* Returns the value of the header Retry-After, written to `out` or a string literal; NULL if
 * waiting does not help. */
enum { API_RETRY = 24 };
const char *api_problem_retry(const api_problem *problem, char out[API_RETRY]);
/* Returns the JSON object that is sent, with status 507, if there is no memory to write a problem;
 * a string literal. */
const char *api_problem_unwritten(void);
/* The JSON members of a problem, and of an element that it is about. */
extern const api_record api_problem_record, api_problem_element_record;
/* Appends the problem as a JSON object to `text`; `request_id` may be NULL. HE_NO_MEMORY is written
 * as API_MEMORY_BUDGET if the memory budget is used up. */
void api_problem_write(const api_problem *problem, const char *request_id, api_text *text);
/* Writes the HTML page that explains a code, served at /problems/{code}. */
void api_problem_page(int code, api_text *text);

#endif
