"""A headless Chromium for the suites, and folders served to it.

Everything that is started ends with the `with` that has started it.
"""
import contextlib
import functools
import http.server
import os
import shutil
import tempfile
import threading

from selenium import webdriver
from selenium.webdriver.chrome.service import Service


class Browser:
    def __init__(self, width=1600, height=1000, dark=False):
        self.size = (width, height)
        self.dark = dark

    def __enter__(self):
        self.profile = tempfile.mkdtemp(prefix='chromium.')
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which('chromium')
        for argument in ['--headless=new', '--no-sandbox', '--hide-scrollbars',
                         '--disable-dev-shm-usage', '--no-first-run',
                         '--disable-background-networking',
                         '--disable-component-update', '--disable-sync',
                         f'--user-data-dir={self.profile}',
                         f'--window-size={self.size[0]},{self.size[1]}']:
            options.add_argument(argument)
        options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
        self.driver = webdriver.Chrome(
            options=options,
            service=Service(shutil.which('chromedriver'),
                            env={**os.environ, 'TMPDIR': self.profile}))
        self.driver.set_script_timeout(30)
        self.resize(*self.size)
        self.theme(self.dark)
        return self

    def __exit__(self, *_):
        self.driver.quit()
        shutil.rmtree(self.profile, ignore_errors=True)

    def theme(self, dark):
        self.driver.execute_cdp_cmd('Emulation.setEmulatedMedia', {
            'features': [{'name': 'prefers-color-scheme',
                          'value': 'dark' if dark else 'light'}]})

    def resize(self, width, height):
        """The page is as wide as said, also below Chromium's least window."""
        self.driver.execute_cdp_cmd('Emulation.setDeviceMetricsOverride', {
            'width': width, 'height': height, 'deviceScaleFactor': 1,
            'mobile': False})

    def get(self, url):
        self.driver.get(url)

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def shot(self, file):
        os.makedirs(os.path.dirname(os.path.abspath(file)), exist_ok=True)
        self.driver.save_screenshot(file)

    def complaints(self):
        """Warnings and errors of the console."""
        return [entry['message'] for entry in self.driver.get_log('browser')
                if entry['level'] in ('SEVERE', 'WARNING')
                and 'favicon' not in entry['message']]


class Folders(http.server.SimpleHTTPRequestHandler):
    def __init__(self, *arguments, folders, **more):
        self.folders = folders
        super().__init__(*arguments, **more)

    def translate_path(self, path):
        path = path.split('?')[0]
        for prefix, folder in self.folders.items():
            if path.startswith(prefix + '/'):
                return os.path.join(folder, path[len(prefix) + 1:])
        return os.path.join(os.devnull, 'none')

    def log_message(self, *_):
        pass


@contextlib.contextmanager
def serve(folders):
    """Address of a server for {prefix: folder}, on the loopback."""
    server = http.server.ThreadingHTTPServer(
        ('127.0.0.1', 0), functools.partial(Folders, folders=folders))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield f'http://127.0.0.1:{server.server_port}'
    finally:
        server.shutdown()
        thread.join()
        server.server_close()
