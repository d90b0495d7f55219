/* tusb_config.h - what TinyUSB is to build: one serial interface.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 */
#ifndef TUSB_CONFIG_H
#define TUSB_CONFIG_H

#define CFG_TUSB_RHPORT0_MODE OPT_MODE_DEVICE
#define CFG_TUD_ENDPOINT0_SIZE 64
#define CFG_TUD_CDC 1
/* Room for several packets each way; a FRAME for 24 channels has 111 bytes. */
#define CFG_TUD_CDC_RX_BUFSIZE 1024
#define CFG_TUD_CDC_TX_BUFSIZE 1024

#endif
