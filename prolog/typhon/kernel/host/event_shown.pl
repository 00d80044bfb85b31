:- module(typhon_event_shown,
          [ event_shown/3               % +Host, +What, -Shown
          ]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/error_text', [abridged/3]).
:- use_module(hosts, [host_option/2]).

/** <module> What of an event leaves the process

Logs and watches get events without the content of messages.  They get it,
bounded in size, where the option log(Address, Kinds) of the host has
messages(content) among Kinds.

*Threading*: any thread.
*/

:- setting(content_characters, positive_integer, 200,
           "Of longer messages the text begins with so many characters").

%!  event_shown(+Host, +What, -Shown) is det.
%
%   Shown is What as logs and watches get it, an event on Host, as of event/4.

event_shown(Host, sent(To, Message), Shown) =>
    (   shows_content(Host)
    ->  content(Message, Content),
        Shown = sent(To, Content)
    ;   Shown = sent(To)
    ).
event_shown(Host, received(From, Message), Shown) =>
    (   shows_content(Host)
    ->  content(Message, Content),
        Shown = received(From, Content)
    ;   Shown = received(From)
    ).
event_shown(_, What, Shown) =>
    Shown = What.

shows_content(Host) :-
    host_option(Host, log(_, Kinds)),
    memberchk(messages(content), Kinds).

%   content(+Message, -Content): Message itself, or if its text is too long, a
%   string that is the beginning of it and ends with three dots.

content(Message, Content) :-
    setting(content_characters, Longest),
    abridged(Message, Longest, Text),
    (   string_length(Text, Length),
        Length > Longest,
        string_concat(_, "...", Text)
    ->  Content = Text
    ;   Content = Message
    ).
