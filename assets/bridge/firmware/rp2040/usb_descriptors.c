/* usb_descriptors.c - what the board tells a computer that it is: a serial port.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * The product's name holds "tactile array", which the rule ../../99-selvedge.rules looks for. The
 * vendor and product numbers are those that the pico-sdk uses for serial ports; a product that is
 * sold needs its own.
 */
#include "pico/unique_id.h"
#include "tusb.h"

enum { VENDOR = 0x2E8A, PRODUCT = 0x000A };
enum { INTERFACE_CONTROL, INTERFACE_DATA, N_INTERFACES };
enum { TEXT_LANGUAGE, TEXT_MAKER, TEXT_PRODUCT, TEXT_SERIAL };
enum { ENDPOINT_NOTIFY = 0x81, ENDPOINT_OUT = 0x02, ENDPOINT_IN = 0x82, BULK = 64 };
enum { LONGEST_TEXT = 31 };

static const tusb_desc_device_t device_descriptor = {
    .bLength = sizeof(tusb_desc_device_t),
    .bDescriptorType = TUSB_DESC_DEVICE,
    .bcdUSB = 0x0200,
    .bDeviceClass = TUSB_CLASS_MISC,
    .bDeviceSubClass = MISC_SUBCLASS_COMMON,
    .bDeviceProtocol = MISC_PROTOCOL_IAD,
    .bMaxPacketSize0 = CFG_TUD_ENDPOINT0_SIZE,
    .idVendor = VENDOR,
    .idProduct = PRODUCT,
    .bcdDevice = 0x0100,
    .iManufacturer = TEXT_MAKER,
    .iProduct = TEXT_PRODUCT,
    .iSerialNumber = TEXT_SERIAL,
    .bNumConfigurations = 1,
};

static const uint8_t configuration[] = {
    TUD_CONFIG_DESCRIPTOR(1, N_INTERFACES, 0, TUD_CONFIG_DESC_LEN + TUD_CDC_DESC_LEN, 0, 250),
    TUD_CDC_DESCRIPTOR(INTERFACE_CONTROL, 0, ENDPOINT_NOTIFY, 8, ENDPOINT_OUT, ENDPOINT_IN, BULK),
};

const uint8_t *tud_descriptor_device_cb(void) { return (const uint8_t *)&device_descriptor; }

const uint8_t *tud_descriptor_configuration_cb(uint8_t index)
{
    (void)index; /* there is one */
    return configuration;
}

/* A text as USB wants it: its length in bytes and its type in the first word, then UTF-16. */
const uint16_t *tud_descriptor_string_cb(uint8_t index, uint16_t language)
{
    static uint16_t words[1 + LONGEST_TEXT];
    char serial[2 * PICO_UNIQUE_BOARD_ID_SIZE_BYTES + 1];
    const char *text;
    unsigned n = 0;
    (void)language;
    switch (index) {
    case TEXT_LANGUAGE: words[1] = 0x0409; n = 1; text = ""; break;
    case TEXT_MAKER: text = "Selvedge firmware kit"; break;
    case TEXT_PRODUCT: text = "tactile array"; break;
    case TEXT_SERIAL:
        pico_get_unique_board_id_string(serial, sizeof serial);
        text = serial;
        break;
    default: return 0;
    }
    for (; *text != 0 && n < LONGEST_TEXT; text++) words[1 + n++] = (uint8_t)*text;
    words[0] = (uint16_t)(TUSB_DESC_STRING << 8 | (2 * n + 2));
    return words;
}
