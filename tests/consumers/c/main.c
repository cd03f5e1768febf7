/* Answers an SDO request: reads the telegram of the heatsink temperature, writes the answer, and names an error. */
#include <inttypes.h>
#include <stdio.h>

#include <drivespec/e94aycca_panel.h>
#include <drivespec/e94aycca_tables.h>
#include <drivespec/e94aycca_telegrams.h>

int main(void)
{
    const uint8_t request[] = { 0x40, 0xC2, 0x5F, 0x00, 0x00, 0x00, 0x00, 0x00 };
    uint8_t answer[E94AYCCA_SDO_SIZE];
    size_t size = 0u;
    e94aycca_sdo_t telegram;
    uint32_t address = 0u;

    if (e94aycca_sdo_decode(request, sizeof request, &telegram) != DRIVESPEC_OK) {
        return 1;
    }
    printf("C%05u\n", (unsigned)servo_drives_9400_code(telegram.index));
    telegram.command = E94AYCCA_SDO_COMMAND_READ_RESPONSE_4_BYTES;
    telegram.data = 43u;
    if (e94aycca_sdo_encode(&telegram, answer, sizeof answer, &size) != DRIVESPEC_OK) {
        return 1;
    }
    for (size_t i = 0u; i < size; i++) {
        printf("%02X%s", (unsigned)answer[i], (i + 1u < size) ? " " : "\n");
    }
    printf("%s\n", drivespec_status_name(e94aycca_sdo_decode(request, 7u, &telegram)));
    if (!e94aycca_switch_node_address_value(UINT32_C(5), &address)) {
        return 1;
    }
    printf("node %" PRIu32 "\n", address);
    return 0;
}
