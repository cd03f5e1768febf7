// The same headers from C++: reads the values of a PROFIdrive response one after another.
#include <cstdio>

#include <drivespec/e94aycpm_telegrams.h>

int main()
{
    const uint8_t response[] = {1, 1, 0, 2, 0x42, 1, 0x12, 0x34, 0x41, 1, 0x56, 0x00};
    e94aycpm_dpv1_read_response_t telegram;

    if (e94aycpm_dpv1_read_response_decode(response, sizeof response, &telegram) != DRIVESPEC_OK) {
        return 1;
    }
    drivespec_cursor cursor = {telegram.values.raw, telegram.values.count};
    e94aycpm_dpv1_read_response_values_t value;
    while (e94aycpm_dpv1_read_response_values_next(&cursor, &value)) {
        std::printf("%u: %llx\n", unsigned{value.format}, static_cast<unsigned long long>(drivespec_get(value.value, true)));
    }
    return 0;
}
