:- module(typhon_page_export,
          [ replay_export/3             % +LogFile, +File, +Options
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(base64), [base64_encoded/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(sgml), [xml_quote_cdata/3]).
:- use_module(library(sha), [sha_hash/3]).
:- use_module(files, [page_file/3]).
:- use_module(json, [json_text/2]).
:- use_module(replay, [replay_dict/3]).

/** <module> A replay as one file

It needs no server and fetches nothing: scripts, styles and the log stand in
it.  Modules are data URLs, which an import map names; so what they import
from `./x.js` they import from `typhon/x.js` there.  By its
Content-Security-Policy scripts run that were written here, and no others.

*Threading*: any thread.
*/

:- multifile prolog:error_message//1.

style('views.css').
style('exported.css').
style('uPlot.min.css').

library('d3-dispatch.min.js').
library('d3-quadtree.min.js').
library('d3-timer.min.js').
library('d3-force.min.js').
library('uPlot.iife.min.js').

%!  replay_export(+LogFile, +File, +Options) is det.
%
%   Write a page that replays LogFile.  Options are those of replay_dict/3.
%
%   @error existence_error(source_sink, LogFile), permission_error(open,
%   source_sink, File)
%   @error existence_error(page_tool, Name) where `make page-tools` has to be
%   called first

replay_export(LogFile, File, Options) :-
    replay_dict(LogFile, Options, Replay),
    findall(Part, part(Replay, Part), Parts),
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8), newline(posix)]),
        write_page(Out, Replay.title, Parts),
        close(Out)).

%   part(+Replay, -Part): style(Text), data(Text) or script(Type, Text).

part(_, style(Text)) :-
    style(Name),
    file_text(Name, Text).
part(Replay, data(Text)) :-
    json_text(Replay, Json),
    without_tags(Json, Text).
part(_, script('text/javascript', Text)) :-
    library(Name),
    file_text(Name, Text).
part(_, script(importmap, Text)) :-
    modules(['exported.js'], [], Modules),
    maplist(module_pair, Modules, Pairs),
    dict_pairs(Imports, _, Pairs),
    json_text(_{imports:Imports}, Text).
part(_, script(module, "import 'typhon/exported.js';")).

file_text(Name, Text) :-
    (   page_file([Name], File, _)
    ->  read_file_to_string(File, Text, [encoding(utf8)])
    ;   existence_error(page_tool, Name)
    ).

%   modules(+Files, +Known0, -Known): File-Text, with what they import.

modules([], Known, Known).
modules([File|Files], Known, Modules) :-
    memberchk(File-_, Known),
    !,
    modules(Files, Known, Modules).
modules([File|Files], Known, Modules) :-
    file_text(File, Text),
    findall(Imported, imported(Text, Imported), New),
    append(New, Files, More),
    modules(More, [File-Text|Known], Modules).

imported(Text, File) :-
    sub_string(Text, _, _, After, "from './"),
    sub_string(Text, _, After, 0, Rest),
    once(sub_string(Rest, Length, _, _, "'")),
    sub_atom(Rest, 0, Length, _, File).

module_pair(File-Text, Name-Address) :-
    replaced(Text, "from './", "from 'typhon/", Rewritten),
    base64_encoded(Rewritten, Encoded, [encoding(utf8), as(string)]),
    atom_concat('typhon/', File, Name),
    string_concat("data:text/javascript;base64,", Encoded, Address).

%   What agents say can end no script.

without_tags(Json, Text) :-
    replaced(Json, "<", "\\u003c", Text).

replaced(Text0, Old, New, Text) :-
    atomic_list_concat(Parts, Old, Text0),
    atomic_list_concat(Parts, New, Text1),
    atom_string(Text1, Text).

                /*******************************
                *             HTML             *
                *******************************/

write_page(Out, Title, Parts) :-
    findall(Source, script_source(Parts, Source), Sources),
    atomic_list_concat(Sources, ' ', Scripts),
    xml_quote_cdata(Title, Quoted, utf8),
    format(Out, '<!doctype html>~n<html lang="en">~n<head>~n\c
                 <meta charset="utf-8">~n\c
                 <meta http-equiv="Content-Security-Policy" content="\c
                 default-src \'none\'; style-src \'unsafe-inline\'; \c
                 img-src data: blob:; script-src data: ~w">~n\c
                 <meta name="viewport" \c
                 content="width=device-width, initial-scale=1">~n\c
                 <title>~w</title>~n', [Scripts, Quoted]),
    forall(member(style(Text), Parts),
           format(Out, '<style>~s</style>~n', [Text])),
    format(Out, '</head>~n<body>~n', []),
    forall(member(Part, Parts), write_script(Out, Part)),
    format(Out, '</body>~n</html>~n', []).

script_source(Parts, Source) :-
    member(script(_, Text), Parts),
    sha_hash(Text, Bytes, [algorithm(sha256), encoding(utf8)]),
    string_codes(Binary, Bytes),
    base64_encoded(Binary, Hash, [encoding(octet), as(atom)]),
    format(atom(Source), '\'sha256-~w\'', [Hash]).

write_script(Out, data(Text)) :-
    format(Out, '<script type="application/json" id="replay">~s</script>~n',
           [Text]).
write_script(Out, script(Type, Text)) :-
    format(Out, '<script type="~w">~s</script>~n', [Type, Text]).
write_script(_, style(_)).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:error_message(existence_error(page_tool, Name)) -->
    [ '~w is missing; `make page-tools` gets it'-[Name] ].
