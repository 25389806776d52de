/* Wrong arguments of all kinds. */
#ifndef WRONG_H
#define WRONG_H

#include "check.h"

#define REFUSED(call) CHECK((call) == HS_INVALID_ARGUMENT)
/* Memory that no structure of the interface is larger than, at an odd address. */
static union { double align; unsigned char bytes[4096]; } memory;
#define ODD(type) ((type *)(void *)(memory.bytes + 1))

/* A call that takes a structure, with every wrong one. */
#define WRONG_STRUCTURES(structure, expression)                                                       \
    do {                                                                                              \
        uint32_t type_ = structure.type, size_ = structure.size;                                      \
        structure.type = 0; REFUSED(expression);                                                      \
        structure.type = type_ + 1; REFUSED(expression);                                              \
        structure.type = type_;                                                                       \
        structure.size = 0; REFUSED(expression);                                                      \
        structure.size = 8; REFUSED(expression);                                                      \
        structure.size = size_ - 1; REFUSED(expression);                                              \
        structure.size = size_ + 8; REFUSED(expression);                                              \
        structure.size = 0xffffffffu; REFUSED(expression);                                            \
        structure.size = size_;                                                                       \
        structure.next = &memory; REFUSED(expression);                                                \
        structure.next = NULL;                                                                        \
    } while (0)

#endif
