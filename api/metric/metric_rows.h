/* metric_rows.h - the table of the metrics of GET /metrics, with name, type, labels and meaning.
 *
 * The page (api/read/metrics.c), the manual hedged(8) and the tests read the rows; a test compares
 * the names in server/alerts.yaml with them. A name says what is measured and then its unit, as
 * https://prometheus.io/docs/practices/naming/ recommends. Clients cannot make new label values: a
 * value that is not known in advance, such as an unknown method, is counted as "other". */
#ifndef HE_API_METRIC_METRIC_ROWS_H
#define HE_API_METRIC_METRIC_ROWS_H

/* Each row: X(constant, name, type, labels separated by commas, meaning) */
#define API_METRIC_MAP(X)                                                                          \
    /* requests */                                                                                 \
    X(REQUESTS, "hedge_http_requests_total", COUNTER, "method,route,status",                       \
      "Requests that ended, by method, by template of the path and by class of the status (the "   \
      "class is none if the client disconnected before the answer).")                              \
    X(REQUEST_TIME, "hedge_http_request_duration_seconds", HISTOGRAM, "method,route,status",       \
      "Time from the request line to the last byte of the answer; for an event stream, to the "    \
      "end of the stream.")                                                                        \
    X(IN_FLIGHT, "hedge_http_requests_in_flight", GAUGE, "",                                       \
      "Requests that began and have not ended, including event streams.")                          \
    X(BYTES_IN, "hedge_http_request_bytes_total", COUNTER, "",                                     \
      "Bytes of request bodies that arrived.")                                                     \
    X(BYTES_OUT, "hedge_http_response_bytes_total", COUNTER, "",                                   \
      "Bytes of response bodies that were sent.")                                                  \
    X(PROBLEMS, "hedge_problems_total", COUNTER, "code",                                           \
      "Requests that were refused or failed, by the code of the problem.")                         \
    /* connections */                                                                              \
    X(CONNECTIONS, "hedge_connections", GAUGE, "", "Connections that are open.")                   \
    X(CONNECTION_LIMIT, "hedge_connections_limit", GAUGE, "",                                      \
      "The number of connections that may be open; further connections are answered 503.")         \
    X(CONNECTIONS_OPENED, "hedge_connections_opened_total", COUNTER, "",                           \
      "Connections that were accepted.")                                                           \
    X(CONNECTIONS_REFUSED, "hedge_connections_refused_total", COUNTER, "reason",                   \
      "Connections that were closed or answered 503 because too many were open (reason limit), "   \
      "because there was no memory for them (memory), or because the server was stopping "         \
      "(stopping).")                                                                               \
    X(CONNECTIONS_LATE, "hedge_connections_timed_out_total", COUNTER, "stage",                     \
      "Connections that were closed because the client took too long: to send the next request "   \
      "(stage idle), to send the headers (head), to send the body (body), or to read the answer "  \
      "(answer).")                                                                                 \
    X(HANDSHAKES, "hedge_tls_handshakes_total", COUNTER, "result",                                 \
      "TLS handshakes that ended. The result is completed, or failed: refused, abandoned by the "  \
      "client, or too slow.")                                                                      \
    X(LIMITED, "hedge_limited_total", COUNTER, "client,limit",                                     \
      "Requests and connections that were refused because one client had reached a limit, by the " \
      "kind of client (token or address) and by the limit.")                                       \
    /* edits */                                                                                    \
    X(EDITS, "hedge_edits_total", COUNTER, "operation,result",                                     \
      "Operations on meshes, by name and result: applied, tried by a dry run, or refused. If a "   \
      "list of operations is refused, the operation that caused this is counted; if a list "       \
      "cannot be stored, all its operations are counted.")                                         \
    X(REVISIONS, "hedge_revisions_total", COUNTER, "", "Revisions of meshes that were made.")      \
    /* meshes */                                                                                   \
    X(MESHES, "hedge_meshes", GAUGE, "", "Meshes in the store, whether in memory or not.")         \
    X(MESH_LIMIT, "hedge_meshes_limit", GAUGE, "",                                                 \
      "The number of meshes that the store may hold.")                                             \
    X(MESHES_LOADED, "hedge_meshes_in_memory", GAUGE, "", "Meshes that are in memory.")            \
    X(ELEMENTS, "hedge_elements", GAUGE, "kind", "Elements of the meshes that are in memory.")     \
    X(EVICTIONS, "hedge_mesh_evictions_total", COUNTER, "",                                        \
      "Meshes that were removed from memory to make space for others.")                            \
    X(LOADS, "hedge_mesh_loads_total", COUNTER, "result",                                          \
      "Attempts to load a mesh from the disk: loaded, absent, damaged, or failed.")                \
    X(LOAD_TIME, "hedge_mesh_load_duration_seconds", HISTOGRAM, "",                                \
      "How long a mesh took to be loaded from the disk.")                                          \
    /* memory */                                                                                   \
    X(MEMORY, "hedge_memory_bytes", GAUGE, "holder",                                               \
      "Bytes that count towards the memory budget: contents of meshes, their histories, "          \
      "snapshots for reads, events for event streams, answers of jobs, connections, and "          \
      "everything else.")                                                                          \
    X(MEMORY_BUDGET, "hedge_memory_budget_bytes", GAUGE, "", "The memory budget; 0 for none.")     \
    X(MEMORY_FULL, "hedge_memory_full", GAUGE, "",                                                 \
      "1 while memory is full: no mesh can be removed from memory, and requests that need much "   \
      "memory are refused. 0 at all other times.")                                                 \
    /* events */                                                                                   \
    X(STREAMS, "hedge_event_streams", GAUGE, "about",                                              \
      "Event streams that are open, by their subject: mesh or job.")                               \
    X(STREAM_LIMIT, "hedge_event_streams_limit", GAUGE, "about",                                   \
      "The number of event streams that may be open.")                                             \
    X(PRESENT, "hedge_clients_present", GAUGE, "",                                                 \
      "Clients that show themselves to the other clients of a mesh.")                              \
    X(EVENTS, "hedge_events_total", COUNTER, "",                                                   \
      "Events about meshes that were written for event streams.")                                  \
    X(EVENT_LAG, "hedge_event_lag_seconds", HISTOGRAM, "",                                         \
      "Time from a change until its event is handed to the connection of an event stream, "        \
      "including the time to make the change durable. Each stream that gets the event counts "     \
      "once.")                                                                                     \
    X(BEHIND, "hedge_event_streams_behind_total", COUNTER, "",                                     \
      "How often an event stream fell so far behind that its client was told to fetch the mesh "   \
      "again.")                                                                                    \
    /* jobs */                                                                                     \
    X(JOBS, "hedge_jobs", GAUGE, "state", "Jobs that the server knows, by state.")                 \
    X(JOBS_ENDED, "hedge_jobs_ended_total", COUNTER, "state",                                      \
      "Jobs that ended, by their last state.")                                                     \
    X(JOB_WAIT, "hedge_job_wait_seconds", HISTOGRAM, "",                                           \
      "How long jobs waited before they started.")                                                 \
    X(JOB_TIME, "hedge_job_duration_seconds", HISTOGRAM, "",                                       \
      "How long jobs ran, from their start to their end.")                                         \
    /* the store */                                                                                \
    X(STORE_STATE, "hedge_store_state", GAUGE, "state",                                            \
      "The state of the store: the series of the current state is 1, the series of the other "     \
      "states are 0. The states are writable, full (the disk has no space) and failed (changes "   \
      "are refused until a restart).")                                                             \
    X(DISK_FULL, "hedge_store_disk_full_total", COUNTER, "",                                       \
      "How often the store found the disk full.")                                                  \
    X(COMMIT_TIME, "hedge_store_commit_duration_seconds", HISTOGRAM, "",                           \
      "How long it took to write and sync a group of changes. Each commit of a group counts "      \
      "once.")                                                                                     \
    X(SYNC_TIME, "hedge_store_sync_duration_seconds", HISTOGRAM, "",                               \
      "How long the last step of a database transaction took: writing to the -wal file and "       \
      "syncing it.")                                                                               \
    X(GROUP_SIZE, "hedge_store_commit_records", HISTOGRAM, "",                                     \
      "How many changes were committed together in one group.")                                    \
    X(PENDING, "hedge_store_records_pending", GAUGE, "",                                           \
      "Changes that were made and are not yet durable.")                                           \
    X(LOST, "hedge_store_records_lost_total", COUNTER, "",                                         \
      "Changes that could not be made durable; none of them was acknowledged.")                    \
    X(QUEUE, "hedge_store_queue_bytes", GAUGE, "", "Bytes of changes that wait for the disk.")     \
    X(QUEUE_LIMIT, "hedge_store_queue_limit_bytes", GAUGE, "",                                     \
      "The number of bytes of changes that may wait for the disk; further changes are refused "    \
      "with store_behind.")                                                                        \
    X(WAL, "hedge_store_wal_bytes", GAUGE, "",                                                     \
      "Bytes of the -wal file that were in use after the last commit.")                            \
    X(CHECKPOINT_TIME, "hedge_store_checkpoint_duration_seconds", HISTOGRAM, "",                   \
      "How long it took to write the -wal file back into the database.")                           \
    /* threads */                                                                                  \
    X(POOL_WAITING, "hedge_pool_tasks_waiting", GAUGE, "pool,share",                               \
      "Tasks that wait for a thread, by pool and share. The pool work runs requests; its shares "  \
      "are brief (short requests), long (long requests) and job (jobs). The pool answers "         \
      "produces parts of answers.")                                                                \
    X(POOL_LIMIT, "hedge_pool_tasks_waiting_limit", GAUGE, "pool,share",                           \
      "The number of tasks that may wait for a thread.")                                           \
    X(POOL_RUNNING, "hedge_pool_tasks_running", GAUGE, "pool,share", "Tasks that run.")            \
    X(POOL_REFUSED, "hedge_pool_tasks_refused_total", COUNTER, "pool,share",                       \
      "Tasks that were refused because too many were waiting.")                                    \
    /* the program */                                                                              \
    X(LOG_DROPPED, "hedge_log_lines_dropped_total", COUNTER, "",                                   \
      "Lines of the log that were dropped because the reader of the log was too slow.")            \
    X(BUILD_INFO, "hedge_build_info", GAUGE, "version,commit",                                     \
      "Always 1; the labels give the version and the commit that the server was built from.")      \
    X(PROCESSOR, "process_cpu_seconds_total", COUNTER, "",                                         \
      "Processor time that the process has used.")                                                 \
    X(RESIDENT, "process_resident_memory_bytes", GAUGE, "", "Resident memory.")                    \
    X(VIRTUAL, "process_virtual_memory_bytes", GAUGE, "", "Virtual memory.")                       \
    X(DESCRIPTORS, "process_open_fds", GAUGE, "", "Open file descriptors.")                        \
    X(MOST_DESCRIPTORS, "process_max_fds", GAUGE, "",                                              \
      "The number of file descriptors that the process may open.")                                 \
    X(STARTED, "process_start_time_seconds", GAUGE, "",                                            \
      "When the process was started, in seconds since 1970 UTC.")

#endif
