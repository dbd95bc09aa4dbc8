#include "server/version.h"

#ifndef SRV_COMMIT
#define SRV_COMMIT ""
#endif

const char srv_commit[] = SRV_COMMIT;
