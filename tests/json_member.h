/* json_member.h - access to the members of a JSON object that a test requires. */
#ifndef TESTS_JSON_MEMBER_H
#define TESTS_JSON_MEMBER_H

#include <cjson/cJSON.h>

/* Returns the member of a JSON object with this name; fails the test if there is none. */
const cJSON *json_member(const cJSON *object, const char *name);

#endif
