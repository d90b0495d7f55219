/* Stands for pico/unique_id.h of the pico-sdk. SPDX-License-Identifier: MIT OR Apache-2.0 */
#pragma once
#include "pico/types.h"
#define PICO_UNIQUE_BOARD_ID_SIZE_BYTES 8
typedef struct { uint8_t id[PICO_UNIQUE_BOARD_ID_SIZE_BYTES]; } pico_unique_board_id_t;
void pico_get_unique_board_id(pico_unique_board_id_t *id_out);
void pico_get_unique_board_id_string(char *id_out, uint len);
