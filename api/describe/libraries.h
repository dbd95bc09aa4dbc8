/* libraries.h - lists the versions of the libraries that api/ calls. */
#ifndef HE_API_DESCRIBE_LIBRARIES_H
#define HE_API_DESCRIBE_LIBRARIES_H

typedef struct api_library {
    const char *name, *version; /* strings that are never freed */
} api_library;

enum { API_LIBRARIES = 3 };

/* Lists the versions of the libraries loaded at run time, which may be newer than those at build
 * time. */
void api_libraries_list(api_library out[API_LIBRARIES]);

#endif
