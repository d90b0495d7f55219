/* Stands for pico/types.h of the pico-sdk. SPDX-License-Identifier: MIT OR Apache-2.0 */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
typedef unsigned int uint;
typedef volatile uint32_t io_rw_32;
#define __uninitialized_ram(group) __attribute__((section(".uninitialized_data." #group))) group
