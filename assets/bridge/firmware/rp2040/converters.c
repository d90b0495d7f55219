/* converters.c - 32 channels of 12 bits on SPI, as the AD5383 has them. Another converter: write
 * these three functions anew.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * A word has 24 bits, first bit first: A/B, R/W, 0, five bits of channel, two of register (11: the
 * data register), twelve of data, two unused. The converter takes a bit at the falling edge of the
 * clock. 24 words of 24 bits take 30 us at 20 MHz, some 60 us with all that is around them: half of
 * the 125 us that there are (counted, not measured).
 */
#include "hardware/gpio.h"
#include "hardware/spi.h"

#include "board.h"
#include "converters.h"

#if HBP_CHANNELS > 32
#error "one converter has 32 channels: a larger array needs more of them, and DMA"
#endif

enum { SPI_HZ = 20000000, MID_SCALE = 2048 };

static void start_output(unsigned pin)
{
    gpio_init(pin);
    gpio_put(pin, 1);
    gpio_set_dir(pin, 1);
}

void converters_start(void)
{
    uint16_t codes[HBP_CHANNELS];
    unsigned channel;
    start_output(PIN_SYNC);
    start_output(PIN_LDAC);
    spi_init(spi0, SPI_HZ);
    spi_set_format(spi0, 8, SPI_CPOL_0, SPI_CPHA_1, SPI_MSB_FIRST);
    gpio_set_function(PIN_SPI_CLOCK, GPIO_FUNC_SPI);
    gpio_set_function(PIN_SPI_DATA, GPIO_FUNC_SPI);
    for (channel = 0; channel < HBP_CHANNELS; channel++) codes[channel] = MID_SCALE;
    converters_write(codes);
    converters_update();
}

void converters_write(const uint16_t codes[HBP_CHANNELS])
{
    unsigned channel;
    for (channel = 0; channel < HBP_CHANNELS; channel++) {
        uint32_t word = (uint32_t)channel << 16 | 3u << 14 | (codes[channel] & 0xFFFu) << 2;
        uint8_t bytes[3] = { (uint8_t)(word >> 16), (uint8_t)(word >> 8), (uint8_t)word };
        gpio_put(PIN_SYNC, 0);
        spi_write_blocking(spi0, bytes, sizeof bytes);
        gpio_put(PIN_SYNC, 1);
    }
}

void converters_update(void)
{
    gpio_put(PIN_LDAC, 0);
    gpio_put(PIN_LDAC, 0); /* again, for the 20 ns that the pulse has to last */
    gpio_put(PIN_LDAC, 0);
    gpio_put(PIN_LDAC, 1);
}
