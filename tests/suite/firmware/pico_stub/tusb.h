/* Stands for tusb.h of TinyUSB. SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * The descriptor macros take the same arguments as the real ones and give other bytes. */
#pragma once
#include <stdbool.h>
#include <stdint.h>
#define OPT_MODE_DEVICE 0x01
#include "tusb_config.h"
enum { TUSB_DESC_DEVICE = 1, TUSB_DESC_CONFIGURATION = 2, TUSB_DESC_STRING = 3 };
enum { TUSB_CLASS_MISC = 0xEF, MISC_SUBCLASS_COMMON = 2, MISC_PROTOCOL_IAD = 1 };
typedef struct __attribute__((packed)) {
    uint8_t bLength, bDescriptorType;
    uint16_t bcdUSB;
    uint8_t bDeviceClass, bDeviceSubClass, bDeviceProtocol, bMaxPacketSize0;
    uint16_t idVendor, idProduct, bcdDevice;
    uint8_t iManufacturer, iProduct, iSerialNumber, bNumConfigurations;
} tusb_desc_device_t;
#define TUD_CONFIG_DESC_LEN 9
#define TUD_CDC_DESC_LEN (8 + 9 + 5 + 5 + 4 + 5 + 7 + 9 + 7 + 7)
#define TUD_CONFIG_DESCRIPTOR(config_num, itfcount, stridx, total_len, attribute, power_ma) \
    9, TUSB_DESC_CONFIGURATION, (total_len) & 255, (total_len) >> 8, itfcount, config_num, stridx, \
        0x80 | (attribute), (power_ma) / 2
#define TUD_CDC_DESCRIPTOR(itfnum, stridx, ep_notif, ep_notif_size, epout, epin, epsize) \
    itfnum, stridx, ep_notif, (ep_notif_size) & 255, (ep_notif_size) >> 8, epout, epin, \
        (epsize) & 255, (epsize) >> 8
bool tusb_init(void);
void tud_task(void);
bool tud_ready(void);
bool tud_cdc_connected(void);
uint32_t tud_cdc_available(void);
int32_t tud_cdc_read_char(void);
uint32_t tud_cdc_write_available(void);
uint32_t tud_cdc_write(void const *buffer, uint32_t bufsize);
uint32_t tud_cdc_write_flush(void);
uint8_t const *tud_descriptor_device_cb(void);
uint8_t const *tud_descriptor_configuration_cb(uint8_t index);
uint16_t const *tud_descriptor_string_cb(uint8_t index, uint16_t langid);
