/* Stands for hardware/adc.h of the pico-sdk. SPDX-License-Identifier: MIT OR Apache-2.0 */
#pragma once
#include "pico/types.h"
void adc_init(void);
void adc_gpio_init(uint gpio);
void adc_select_input(uint input);
uint16_t adc_read(void);
