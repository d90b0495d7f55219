/* trap.c - linked into the firmware of the emulated board by its test: four bytes F0 F1 F2 F3 in a
 * row run into an instruction that no processor knows, as a stray pointer would.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#include "hbp_core.h"

void __real_hbp_receive(hbp_device *device, uint16_t phase_us, uint8_t byte);
void __wrap_hbp_receive(hbp_device *device, uint16_t phase_us, uint8_t byte);

void __wrap_hbp_receive(hbp_device *device, uint16_t phase_us, uint8_t byte)
{
    static uint32_t last;
    last = last << 8 | byte;
    if (last == 0xF0F1F2F3u) __asm volatile("udf #0");
    __real_hbp_receive(device, phase_us, byte);
}
