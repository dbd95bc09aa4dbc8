/* libraries.h - which libraries run here: those that api/ calls. */
#ifndef HE_API_DESCRIBE_LIBRARIES_H
#define HE_API_DESCRIBE_LIBRARIES_H

typedef struct api_library {
    const char *name, *version; /* static */
} api_library;

enum { API_LIBRARIES = 3 };

/* The versions of the libraries that the process was given, which may be newer than those that it
 * was built with. */
void api_libraries_list(api_library out[API_LIBRARIES]);

#endif
