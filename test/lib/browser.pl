:- module(test_browser,
          [ with_browser/2,             % -Browser, :Goal
            with_firefox/2,             % -Browser, :Goal
            browser_open/2,             % +Browser, +Address
            browser_run/3,              % +Browser, +Script, -Result
            browser_run/4,              % +Browser, +Script, +Arguments, -Result
            browser_wait/2,             % +Browser, +Script
            browser_wait/3,             % +Browser, +Script, +Seconds
            browser_keys/2,             % +Browser, +Keys
            browser_click/2,            % +Browser, +Selector
            browser_hold/3,             % +Browser, +Selector, :Goal
            browser_drag/3,             % +Browser, +From, +To
            browser_size/3,             % +Browser, +Width, +Height
            browser_theme/2,            % +Browser, +Theme
            browser_shot/2,             % +Browser, +File
            browser_tabs/2,             % +Browser, -Tabs
            browser_tab/2,              % +Browser, -Tab
            browser_goto_tab/2,         % +Browser, +Tab
            browser_complaints/2,       % +Browser, -Texts
            browser_barriers/2          % +Browser, -Texts
          ]).

/** <module> A Chromium for tests, or a Firefox

Chromium is driven by chromedriver, through the W3C WebDriver protocol, Firefox
by the same commands in its own protocol, Marionette, which needs no driver.  It
has no browser_theme/2, browser_tabs/2 and browser_complaints/2.

*Threading*: one thread at a time uses a browser.
*/

:- use_module(common,
              [free_port/1, project_file/2, wait_until/2, with_tmp_dir/1]).
:- use_module(texts, [write_file/3]).
:- use_module(library(base64), [base64/2]).
:- use_module(library(filesex), [delete_directory_contents/1]).
:- use_module(library(http/http_json), []).
:- use_module(library(http/json), [atom_json_dict/3]).
:- use_module(library(http/http_client),
              [http_delete/3, http_get/3, http_post/4]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), 
              [ process_create/3, process_kill/1, process_kill/2,
                process_wait/2 ]).
:- use_module(library(readutil), [read_file_to_string/3, read_line_to_string/2]).
:- use_module(library(socket), [tcp_connect/3]).
:- use_module(library(utf8), [utf8_codes/3]).

:- meta_predicate
    with_browser(-, 0),
    with_firefox(-, 0),
    browser_hold(+, +, 0).

%!  with_browser(-Browser, :Goal) is semidet.
%
%   Call Goal once while Browser is there.

with_browser(Browser, Goal) :-
    with_tmp_dir(browsing(Browser, Goal)).

%   Chromium leaves files in its directory, and on a busy machine still writes
%   there for a moment after its driver has ended.

browsing(Browser, Goal, Dir) :-
    setup_call_cleanup(
        driver(Dir, Pid, Out, Port),
        with_session(Port, Browser, Goal),
        ( end_driver(Pid, Out),
          wait_until(emptied(Dir), 20) )).

emptied(Dir) :-
    catch(delete_directory_contents(Dir), error(_, _), fail).

with_session(Port, Browser, Goal) :-
    setup_call_cleanup(
        session(Port, Browser),
        once(Goal),
        end_session(Browser)).

session(Port, browser(Base)) :-
    format(atom(Driver), 'http://127.0.0.1:~w/session', [Port]),
    capabilities(Wanted),
    call_driver(post, Driver, Wanted, Answer),
    atomic_list_concat([Driver, /, Answer.sessionId], Base).

end_session(browser(Base)) :-
    catch(http_delete(Base, _, [json_object(dict)]), error(_, _), true).

%   The driver chooses a port that is free for IPv6, and ends if the port is
%   in use for IPv4, or if the port that we chose was taken meanwhile.

driver(Dir, Pid, Out, Port) :-
    between(1, 10, _),
    free_port(Port),
    format(atom(Argument), '--port=~d', [Port]),
    process_create(path(chromedriver), [Argument],
                   [ stdin(null), stdout(pipe(Out)), stderr(null),
                     environment(['TMPDIR'=Dir]), process(Pid) ]),
    (   listens(Out)
    ->  !
    ;   end_driver(Pid, Out),
        fail
    ).
driver(_, _, _, _) :-
    throw(error(browser('not started', 'chromedriver finds no port'), _)).

end_driver(Pid, Out) :-
    catch(process_kill(Pid), error(existence_error(_, _), _), true),
    process_wait(Pid, _),
    close(Out).

listens(Out) :-
    read_line_to_string(Out, Line),
    string(Line),
    (   sub_string(Line, _, _, _, "successfully on port ")
    ->  true
    ;   listens(Out)
    ).

%!  with_firefox(-Browser, :Goal) is semidet.
%
%   Call Goal once while the Firefox Browser is there.

with_firefox(Browser, Goal) :-
    with_tmp_dir(firefox(Browser, Goal)).

firefox(Browser, Goal, Dir) :-
    atom_concat(Dir, '/user.js', Prefs),
    write_file(Prefs, 'user_pref("marionette.port", 0);~n\c
        user_pref("browser.shell.checkDefaultBrowser", false);~n', []),
    setup_call_cleanup(
        process_create(path('firefox-esr'),
                       [ '--headless', '--no-remote', '--marionette',
                         '--profile', Dir, 'about:blank' ],
                       [ stdin(null), stdout(null), stderr(null),
                         environment(['HOME'=Dir, 'TMPDIR'=Dir]), process(Pid) ]),
        with_marionette(Dir, Browser, Goal),
        ( process_kill(Pid),
          process_wait(Pid, _),
          wait_until(emptied(Dir), 20) )).

with_marionette(Dir, firefox(In, Out), Goal) :-
    atom_concat(Dir, '/MarionetteActivePort', File),
    wait_until(port_in(File, Port), 60),
    setup_call_cleanup(
        tcp_connect('127.0.0.1':Port, Stream, []),
        ( stream_pair(Stream, In, Out),
          set_stream(Stream, encoding(octet)),
          heard(In, _),
          marionette(firefox(In, Out), 'NewSession', _{}, _),
          marionette(firefox(In, Out), 'SetTimeouts', _{script:120000}, _),
          once(Goal) ),
        close(Stream, [force(true)])).

port_in(File, Port) :-
    exists_file(File),
    read_file_to_string(File, Text, []),
    catch(number_string(Port, Text), error(_, _), fail).

%   A frame is JSON after its length in bytes and a colon.

marionette(firefox(In, Out), Command, Body, Value) :-
    atom_concat('WebDriver:', Command, Name),
    atom_json_dict(Text, [0, 0, Name, Body], [as(codes), width(0)]),
    phrase(utf8_codes(Text), Bytes),
    length(Bytes, Length),
    format(Out, '~d:~s', [Length, Bytes]),
    flush_output(Out),
    heard(In, [_, _, Error, Result]),
    (   Error == null
    ->  Value = Result
    ;   throw(error(browser(Error.error, Error.message), _))
    ).

heard(In, Term) :-
    read_length(In, Length),
    read_string(In, Length, Read),
    string_codes(Read, Bytes),
    phrase(utf8_codes(Codes), Bytes),
    atom_json_dict(Codes, Term, []).

read_length(In, Length) :-
    read_string(In, ":", "", _, Digits),
    number_string(Length, Digits).

marionette_name(url, 'Navigate').
marionette_name('execute/async', 'ExecuteAsyncScript').
marionette_name(actions, 'PerformActions').
marionette_name(window/rect, 'SetWindowRect').

capabilities(_{capabilities:_{alwaysMatch:_{
    browserName:"chrome",
    timeouts:_{script:120000},
    'goog:loggingPrefs':_{browser:"ALL"},
    'goog:chromeOptions':_{args:[
        "--headless=new", "--no-sandbox", "--disable-gpu",
        "--disable-dev-shm-usage", "--disable-extensions", "--no-first-run",
        "--hide-scrollbars", "--window-size=1600,1000",
        "--force-device-scale-factor=1"]}}}}).

call_driver(Method, Address, Body, Value) :-
    Options = [json_object(dict), status_code(_), tag(''), default_tag('')],
    (   Method == post
    ->  http_post(Address, json(Body), Answer, Options)
    ;   http_get(Address, Answer, Options)
    ),
    Value = Answer.value,
    (   is_dict(Value),
        get_dict(error, Value, Error)
    ->  throw(error(browser(Error, Value.message), _))
    ;   true
    ).

command(firefox(In, Out), Path, Body, Value) :-
    marionette_name(Path, Name),
    marionette(firefox(In, Out), Name, Body, Result),
    ( get_dict(value, Result, Value) -> true ; Value = Result ).
command(browser(Base), Path, Body, Value) :-
    atomic_list_concat([Base, /, Path], Address),
    call_driver(post, Address, Body, Value).

asked(browser(Base), Path, Value) :-
    atomic_list_concat([Base, /, Path], Address),
    call_driver(get, Address, none, Value).

%!  browser_open(+Browser, +Address) is det.

browser_open(Browser, Address) :-
    atom_string(Address, Url),
    command(Browser, url, _{url:Url}, _).

%!  browser_run(+Browser, +Script, -Result) is det.
%!  browser_run(+Browser, +Script, +Arguments, -Result) is det.
%
%   Script is the body of an asynchronous function.

browser_run(Browser, Script, Result) :-
    browser_run(Browser, Script, [], Result).

browser_run(Browser, Script, Arguments, Result) :-
    format(string(Whole),
           "const given = [...arguments], done = given.pop(); \c
            (async (...args) => { ~w })(...given).then(done, \c
            error => done({failed: String(error)}));", [Script]),
    command(Browser, 'execute/async', _{script:Whole, args:Arguments}, Result),
    (   is_dict(Result),
        get_dict(failed, Result, Why)
    ->  throw(error(browser(script, Why), _))
    ;   true
    ).

%!  browser_wait(+Browser, +Script) is det.
%!  browser_wait(+Browser, +Script, +Seconds) is det.
%
%   Wait until Script returns a true value.

browser_wait(Browser, Script) :-
    browser_wait(Browser, Script, 15).

browser_wait(Browser, Script, Seconds) :-
    format(string(Test), "return Boolean((() => { ~w })());", [Script]),
    catch(wait_until(browser_run(Browser, Test, true), Seconds),
          error(timeout_error(_, _), _),
          throw(error(timeout_error(browser, Script), _))).

%!  browser_keys(+Browser, +Keys:list) is det.
%
%   Strings are typed; atoms are keys: tab, enter, escape, left, up, right, down,
%   home, end, shift_tab.

browser_keys(Browser, Keys) :-
    findall(Action, ( member(Key, Keys), key_action(Key, Action) ), Actions),
    command(Browser, actions,
            _{actions:[_{type:"key", id:"keys", actions:Actions}]}, _).

key_action(Key, Action) :-
    string(Key),
    !,
    string_chars(Key, Chars),
    member(Char, Chars),
    atom_string(Char, Text),
    press(Text, Action).
key_action(shift_tab, Action) :-
    !,
    code(shift, Shift),
    code(tab, Tab),
    member(Action, [ _{type:"keyDown", value:Shift},
                     _{type:"keyDown", value:Tab},
                     _{type:"keyUp", value:Tab},
                     _{type:"keyUp", value:Shift} ]).
key_action(Key, Action) :-
    code(Key, Text),
    press(Text, Action).

press(Text, _{type:"keyDown", value:Text}).
press(Text, _{type:"keyUp", value:Text}).

code(Key, Text) :-
    key(Key, Code),
    string_codes(Text, [Code]).

key(tab, 0xE004).
key(enter, 0xE007).
key(shift, 0xE008).
key(escape, 0xE00C).
key(end, 0xE010).
key(home, 0xE011).
key(left, 0xE012).
key(up, 0xE013).
key(right, 0xE014).
key(down, 0xE015).

%!  browser_click(+Browser, +Selector) is det.
%
%   Click at the middle of the first visible element of Selector, as soon as
%   there is one; or of Selector-Text, the one with that text.
%
%!  browser_hold(+Browser, +Selector, :Goal) is semidet.
%
%   The same, and Goal is called between pressing and releasing.
%
%!  browser_drag(+Browser, +From, +To) is det.
%
%   From one point, X-Y, to another.

browser_click(Browser, What) :-
    middle(Browser, What, X, Y),
    pointer(Browser, [at(X, Y), down, up]).

browser_hold(Browser, What, Goal) :-
    middle(Browser, What, X, Y),
    pointer(Browser, [at(X, Y), down]),
    call_cleanup(once(Goal), pointer(Browser, [up])).

middle(Browser, What, X, Y) :-
    ( What = Selector-Text -> true ; Selector = What, Text = "" ),
    format(string(Found),
           "[...document.querySelectorAll(~q)].find(e => e.checkVisibility() && \c
            !e.disabled && (e.textContent.trim() === ~q || ~q === ''))",
           [Selector, Text, Text]),
    format(string(There), "return ~s", [Found]),
    browser_wait(Browser, There),
    format(string(Middle),
           "const e = ~s; e.scrollIntoView({block: 'nearest'}); \c
            const r = e.getBoundingClientRect(); \c
            return [r.x + r.width / 2, r.y + r.height / 2]", [Found]),
    browser_run(Browser, Middle, [X, Y]).

browser_drag(Browser, X0-Y0, X-Y) :-
    X1 is (X0+X)/2,
    Y1 is (Y0+Y)/2,
    pointer(Browser, [at(X0, Y0), down, at(X1, Y1), at(X, Y), up]).

pointer(Browser, Steps) :-
    findall(Action, ( member(Step, Steps), pointed(Step, Action) ), Actions),
    command(Browser, actions,
            _{actions:[_{ type:"pointer", id:"mouse",
                          parameters:_{pointerType:"mouse"},
                          actions:Actions }]}, _).

pointed(at(X0, Y0), _{type:"pointerMove", duration:20, x:X, y:Y}) :-
    X is round(X0),
    Y is round(Y0).
pointed(down, _{type:"pointerDown", button:0}).
pointed(up, _{type:"pointerUp", button:0}).

%!  browser_size(+Browser, +Width, +Height) is det.
%!  browser_theme(+Browser, +Theme) is det.
%
%   The size of the window, in pixels; `light` or `dark`.

browser_size(firefox(In, Out), Width, Height) :-
    !,
    command(firefox(In, Out), window/rect, _{width:Width, height:Height}, _).
browser_size(Browser, Width, Height) :-
    cdp(Browser, "Emulation.setDeviceMetricsOverride",
        _{width:Width, height:Height, deviceScaleFactor:1, mobile:false}).

browser_theme(Browser, Theme) :-
    atom_string(Theme, Value),
    cdp(Browser, "Emulation.setEmulatedMedia",
        _{features:[_{name:"prefers-color-scheme", value:Value}]}).

cdp(Browser, Command, Parameters) :-
    command(Browser, 'goog/cdp/execute', _{cmd:Command, params:Parameters}, _).

%!  browser_shot(+Browser, +File) is det.
%
%   A screenshot, as PNG.

browser_shot(Browser, File) :-
    asked(Browser, screenshot, Encoded),
    base64(Bytes, Encoded),
    setup_call_cleanup(
        open(File, write, Out, [encoding(octet)]),
        write(Out, Bytes),
        close(Out)).

%!  browser_tabs(+Browser, -Tabs:list) is det.
%!  browser_tab(+Browser, -Tab) is det.
%!  browser_goto_tab(+Browser, +Tab) is det.
%
%   The open tabs; open a new tab and switch to it; switch to a tab.

browser_tabs(Browser, Tabs) :-
    asked(Browser, 'window/handles', Tabs).

browser_tab(Browser, Tab) :-
    command(Browser, 'window/new', _{type:"tab"}, Value),
    Tab = Value.handle,
    browser_goto_tab(Browser, Tab).

browser_goto_tab(Browser, Tab) :-
    command(Browser, window, _{handle:Tab}, _).

%!  browser_complaints(+Browser, -Texts) is det.
%
%   The messages in the console of the page since the last call: errors, and
%   violations of its policy.

browser_complaints(Browser, Texts) :-
    command(Browser, 'se/log', _{type:"browser"}, Entries),
    findall(Text,
            ( member(Entry, Entries),
              Entry.level == "SEVERE",
              Text = Entry.message ),
            Texts).

%!  browser_barriers(+Browser, -Texts) is det.
%
%   What axe-core finds on the page that keeps people from using it: problems
%   that are serious.

browser_barriers(Browser, Texts) :-
    (   browser_run(Browser, "return Boolean(globalThis.axe)", true)
    ->  true
    ;   project_file('test/lib/axe/axe.min.js', File),
        read_file_to_string(File, Axe, [encoding(utf8)]),
        browser_run(Browser, Axe, _)
    ),
    browser_run(Browser,
                "const found = await axe.run(document, {resultTypes: ['violations']});
                 return found.violations.filter(v => ['serious', 'critical']
                     .includes(v.impact)).map(v => `${v.id}: ${v.nodes.slice(0, 3)
                     .map(n => n.html.slice(0, 120)).join(' ')}`)", Texts).
