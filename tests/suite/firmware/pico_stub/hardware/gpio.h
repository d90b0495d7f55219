/* Stands for hardware/gpio.h of the pico-sdk. SPDX-License-Identifier: MIT OR Apache-2.0 */
#pragma once
#include "pico/types.h"
typedef enum gpio_function { GPIO_FUNC_SPI = 1, GPIO_FUNC_SIO = 5 } gpio_function_t;
void gpio_init(uint gpio);
void gpio_set_dir(uint gpio, bool out);
void gpio_put(uint gpio, bool value);
void gpio_xor_mask(uint32_t mask);
void gpio_set_function(uint gpio, gpio_function_t fn);
