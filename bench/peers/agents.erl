%% Erlang's agents for bench/peers.pl: processes.
%%
%%   erl -noshell ... -run agents main There Ebin start | idle | messages
%%
%% A message is a binary; the other process is a node, see hop.erl.

-module(agents).
-export([main/1]).

-define(TEXT, <<"0123456789012345678901234567890123456789"
                "0123456789012345678901234567890123456789"
                "01234567890123456789">>).

main([There, Ebin, Part]) ->
    part(Part, There, Ebin),
    halt().

part("start", _, _) ->
    answers(1),
    hop:tell("done(start, 1)", []),
    hop:tell("version('Erlang/OTP ~s')", [erlang:system_info(otp_release)]);
part("idle", _, _) ->
    Facts = [{fact, I, {value, I}} || I <- lists:seq(1, 10)],
    hop:measured("memory", 10000, fun() -> idle(10000, Facts) end);
part("messages", There, Ebin) ->
    answers(500),                       % warm up
    hop:measured("answers", 200000, fun() -> answers(200000) end),
    pairs("local", node(), 25),
    {ok, Peer, Node} = hop:start(There, Ebin),
    pairs("remote", Node, 1),
    peer:stop(Peer).

%% Each process has a copy of the facts.

idle(Count, Facts) ->
    [spawn(fun() -> mute(Facts) end) || _ <- lists:seq(1, Count)].

mute(Facts) ->
    receive
        Message -> mute([Message|Facts])
    end.

answers(0) ->
    ok;
answers(N) ->
    Agent = spawn(fun answer/0),
    Agent ! {self(), ?TEXT},
    receive {Agent, _} -> answers(N - 1) end.

answer() ->
    receive {From, Text} -> From ! {self(), Text} end.

pairs(Where, Node, Times) ->
    paired(1, 1000, Node),              % warm up
    hop:measured(Where ++ "(one)", Times * 20000,
                 fun() -> paired(1, Times * 20000, Node) end),
    hop:measured(Where ++ "(ten)", Times * 40000,
                 fun() -> paired(10, Times * 40000, Node) end).

paired(Pairs, Messages, Node) ->
    Self = self(),
    Rounds = Messages div (2 * Pairs),
    [spawn(fun() ->
               Pong = spawn_link(Node, fun pong/0),
               ping(Rounds, Pong),
               Self ! done
           end) || _ <- lists:seq(1, Pairs)],
    [receive done -> ok end || _ <- lists:seq(1, Pairs)].

ping(0, Pong) ->
    Pong ! stop;
ping(N, Pong) ->
    Pong ! {self(), ?TEXT},
    receive {Pong, _} -> ping(N - 1, Pong) end.

pong() ->
    receive
        {From, Text} -> From ! {self(), Text}, pong();
        stop -> ok
    end.
