/* board.h - which pin does what. The one file of this port to edit besides converters.c.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef BOARD_H
#define BOARD_H

/* High voltage is on while PIN_HV_ENABLE is high AND PIN_DEAD_MAN swings. A resistor of 10 kOhm
 * pulls PIN_HV_ENABLE to ground: after a reset every pin is an input, and the supply off. */
#define PIN_HV_ENABLE 14
#define PIN_DEAD_MAN 15 /* 4 kHz into a charge pump or a monostable that lets go within 5 ms */

/* The measured high voltage, divided down to at most 3.3 V: input 0 of the converter, GPIO 26. */
#define PIN_HV_MEASURED 26
#define ADC_HV_MEASURED 0
#define HV_FULL_SCALE_DV 1000 /* 0.1 V at 3.3 V on the pin */

/* Converters on SPI 0. */
#define PIN_SPI_CLOCK 18
#define PIN_SPI_DATA 19
#define PIN_SYNC 17 /* low during each word */
#define PIN_LDAC 20 /* a low pulse puts all new values out at once */

#endif
