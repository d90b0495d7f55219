/* Stands for the register block of that name in the pico-sdk for RP2040.
 * SPDX-License-Identifier: MIT OR Apache-2.0 */
#pragma once
#include "pico/types.h"
typedef struct { io_rw_32 vreg, bod, chip_reset; } vreg_and_chip_reset_hw_t;
extern vreg_and_chip_reset_hw_t *const vreg_and_chip_reset_hw;
#define VREG_AND_CHIP_RESET_CHIP_RESET_HAD_POR_BITS 0x00000100u
