// The table of the module libalhazen_exr.so.

#include "alhazen/imaging/codecs/exr_functions.h"

extern "C" __attribute__((visibility("default"))) const alhazen::ExrFunctions alhazen_exr_functions;
const alhazen::ExrFunctions alhazen_exr_functions;
