/* hbp_config.h - what this array is, and the build-time maxima that no CONFIG gets beyond.
 *
 * SPDX-License-Identifier: MIT OR Apache-2.0
 *
 * The one file of the core that a port edits; -DHBP_ROWS=10 on the compiler's command line does too.
 */
#ifndef HBP_CONFIG_H
#define HBP_CONFIG_H

#ifndef HBP_ROWS /* the fingertip end first */
#define HBP_ROWS 6
#endif
#ifndef HBP_COLS /* left first; channels are numbered row by row */
#define HBP_COLS 4
#endif
#ifndef HBP_PITCH_UM /* distance of neighbouring contactors */
#define HBP_PITCH_UM 2000
#endif
#ifndef HBP_QUEUE /* frames that can wait; a power of two, at most 128 */
#define HBP_QUEUE 4
#endif
#ifndef HBP_MAX_BODY /* largest decoded body, header and CRC included; <= 1024 */
#define HBP_MAX_BODY 256
#endif
#ifndef HBP_FS_MV /* drive peak of a component in mV at code 65535 */
#define HBP_FS_MV 50000
#endif
#ifndef HBP_HV_MAX_DV /* high voltage, 0.1 V */
#define HBP_HV_MAX_DV 600
#endif
#ifndef HBP_SLEW_MAX /* change of a code per tick */
#define HBP_SLEW_MAX 65535
#endif
#ifndef HBP_LIMIT_40 /* largest code at 40 Hz */
#define HBP_LIMIT_40 65535
#endif
#ifndef HBP_LIMIT_320 /* largest code at 320 Hz */
#define HBP_LIMIT_320 65535
#endif
#ifndef HBP_IDENT /* 0: without IDENT */
#define HBP_IDENT 1
#endif
#ifndef HBP_UID /* exactly 12 bytes; better: the chip's own number */
#define HBP_UID "selvedge-ref"
#endif
#ifndef HBP_NAME /* UTF-8, at most 32 bytes */
#define HBP_NAME "reference firmware"
#endif

#endif
