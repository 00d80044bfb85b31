#!/usr/bin/env python3
"""Frames per second of the map in a headless Chromium.

    frames.py [--seconds 10] [--shot FILE] [NAME=VALUE ...]

NAME=VALUE are those of frames.js: rows, columns, agents, hops, processes.
Prints one line per figure. What draws is Chromium's software renderer unless
the machine has a graphics card that headless Chromium can use.
"""
import argparse
import os

import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))

from browser import Browser, serve


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--seconds', type=float, default=10)
    parser.add_argument('--shot')
    parser.add_argument('--size', default='1600x1000')
    parser.add_argument('--dark', action='store_true')
    parser.add_argument('given', nargs='*')
    options = parser.parse_args()
    page = os.path.join(ROOT, 'prolog', 'typhon', 'page')
    folders = {'/www': os.path.join(page, 'www'),
               '/vendor': os.path.join(page, 'node_modules'),
               '/bench': HERE}
    width, height = map(int, options.size.split('x'))
    with serve(folders) as address, \
            Browser(width, height, dark=options.dark) as browser:
        browser.get(f'{address}/bench/frames.html?{"&".join(options.given)}')
        time.sleep(3)
        browser.run('measure.start()')
        time.sleep(options.seconds)
        result = browser.run('return measure.result()')
        for name, value in result.items():
            print(f'{name:16} {value:.2f}')
        for line in browser.complaints():
            print(line)
        if options.shot:
            browser.shot(options.shot)


if __name__ == '__main__':
    main()
